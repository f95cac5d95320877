//! OctoMap's occupancy octree and its file formats `.bt` and `.ot` \[Hornung2013\].
//!
//! A `.bt` file is a text header, `# Octomap OcTree binary file`, then lines `id OcTree`,
//! `size NODES`, `res METRES`, `data`; then the inner nodes depth first, two bytes
//! each: for child i the bits 2i and 2i+1, `00` unknown, `10` free, `01` occupied,
//! `11` inner (lower bit first). Child i lies on the upper side in x, y and z if bit
//! 0, 1 and 2 of i is set. A leaf above the lowest level stands for all of its cube.
//!
//! An `.ot` file begins with `# Octomap OcTree file` and has all nodes, depth first, five
//! bytes each: the logarithm of the odds that it is occupied, a little-endian `f32`, and
//! one bit for each child that there is; a node without is a leaf, free below 0.

use std::io::{self, BufRead, Read, Write};

/// Levels below the root.
const DEPTH: u32 = 16;

/// The voxel that the tree is centred on has this number on every axis.
const CENTRE: i32 = 1 << (DEPTH - 1);

/// First line of a `.bt` file.
const MAGIC: &str = "# Octomap OcTree binary file";

/// First line of an `.ot` file.
const FULL_MAGIC: &str = "# Octomap OcTree file";

/// Most bytes of a header that is read.
const LONGEST_HEADER: u64 = 4096;

/// Most nodes of a tree that is read: half a gigabyte at worst.
const MOST_NODES: usize = 1 << 22;

/// Column, row and level of a voxel; voxel (0, 0, 0) has its lower corner at the
/// origin. From -32768 to 32767.
pub type Voxel = [i32; 3];

#[derive(Clone, Debug, PartialEq, Eq)]
enum Node {
    Leaf { occupied: bool },
    Inner(Box<[Option<Node>; 8]>),
}

/// A set of voxels known to be free or occupied.
#[derive(Clone, Debug, PartialEq)]
pub struct OcTree {
    resolution: f64,
    root: Option<Node>,
}

/// A cube of equal voxels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cube {
    /// Its voxel with the lowest coordinates.
    pub corner: Voxel,
    /// Voxels along its side.
    pub side: i32,
    /// Whether it is occupied, not free.
    pub occupied: bool,
}

impl OcTree {
    /// A tree with nothing known; a voxel's side is `resolution` metres.
    pub fn new(resolution: f64) -> Self {
        Self {
            resolution,
            root: None,
        }
    }

    /// Side of a voxel in metres.
    pub fn resolution(&self) -> f64 {
        self.resolution
    }

    /// Makes `voxel` known; voxels beyond the tree's ends are ignored.
    pub fn insert(&mut self, voxel: Voxel, occupied: bool) {
        let key = voxel.map(|coordinate| coordinate + CENTRE);
        if key.iter().all(|k| (0..2 * CENTRE).contains(k)) {
            insert(&mut self.root, key, DEPTH, occupied);
        }
    }

    /// Number of nodes, as OctoMap counts them: inner nodes and leaves.
    pub fn nodes(&self) -> usize {
        fn count(node: &Node) -> usize {
            match node {
                Node::Leaf { .. } => 1,
                Node::Inner(children) => 1 + children.iter().flatten().map(count).sum::<usize>(),
            }
        }
        self.root.as_ref().map_or(0, count)
    }

    /// All known cubes.
    pub fn cubes(&self) -> Vec<Cube> {
        fn collect(node: &Node, corner: Voxel, depth: u32, cubes: &mut Vec<Cube>) {
            match node {
                Node::Leaf { occupied } => {
                    cubes.push(Cube {
                        corner,
                        side: 1 << depth,
                        occupied: *occupied,
                    });
                }
                Node::Inner(children) => {
                    let half = 1 << (depth - 1);
                    for (i, child) in children.iter().enumerate() {
                        let Some(child) = child else { continue };
                        let corner =
                            [0, 1, 2].map(|axis| corner[axis] + half * (i as i32 >> axis & 1));
                        collect(child, corner, depth - 1, cubes);
                    }
                }
            }
        }
        let mut cubes = Vec::new();
        if let Some(root) = &self.root {
            collect(root, [-CENTRE; 3], DEPTH, &mut cubes);
        }
        cubes
    }

    /// Writes the tree as a `.bt` file.
    pub fn write(&self, mut to: impl Write) -> io::Result<()> {
        fn emit(node: &Node, to: &mut impl Write) -> io::Result<()> {
            let Node::Inner(children) = node else {
                return Ok(());
            };
            let code = |child: &Option<Node>| match child {
                None => 0b00,
                Some(Node::Leaf { occupied: false }) => 0b01,
                Some(Node::Leaf { occupied: true }) => 0b10,
                Some(Node::Inner(_)) => 0b11,
            };
            let bits = children
                .iter()
                .rev()
                .fold(0u16, |bits, child| bits << 2 | code(child));
            to.write_all(&bits.to_le_bytes())?;
            children
                .iter()
                .flatten()
                .try_for_each(|child| emit(child, to))
        }
        writeln!(
            to,
            "{MAGIC}\nid OcTree\nsize {}\nres {}\ndata",
            self.nodes(),
            self.resolution
        )?;
        self.root
            .as_ref()
            .map_or(Ok(()), |root| emit(root, &mut to))
    }

    /// Whether a file that begins like this is one of the two kinds.
    pub fn is_tree(bytes: &[u8]) -> bool {
        [MAGIC, FULL_MAGIC]
            .iter()
            .any(|magic| bytes.starts_with(magic.as_bytes()))
    }

    /// Reads a `.bt` or `.ot` file of at most 4,194,304 nodes.
    ///
    /// # Errors
    /// What is wrong with the file, or that it cannot be read.
    pub fn read(mut from: impl BufRead) -> io::Result<Self> {
        let mut header = from.by_ref().take(LONGEST_HEADER);
        let mut line = String::new();
        header.read_line(&mut line)?;
        let is_full = line.starts_with(FULL_MAGIC);
        if !is_full && !line.starts_with(MAGIC) {
            return Err(invalid("not an OctoMap tree"));
        }
        let (mut size, mut resolution) = (None, None);
        loop {
            line.clear();
            if header.read_line(&mut line)? == 0 {
                return Err(invalid("the header has no data line"));
            }
            match line.trim().split_once(' ') {
                Some(("size", value)) => size = value.parse::<usize>().ok(),
                Some(("res", value)) => resolution = value.parse::<f64>().ok(),
                Some(("id", id)) if id != "OcTree" => {
                    return Err(invalid("not an occupancy tree, which has `id OcTree`"));
                }
                None if line.trim() == "data" => break,
                _ => {}
            }
        }
        let size = size.ok_or_else(|| invalid("the header has no size, a number of nodes"))?;
        if size > MOST_NODES {
            let reason = format!("{size} nodes by its header; at most {MOST_NODES} are read");
            return Err(invalid(reason));
        }
        let resolution = resolution
            .filter(|side| *side > 0.0 && side.is_finite())
            .ok_or_else(|| invalid("the header has no resolution above 0"))?;
        let mut left = size;
        let root = match size {
            0 => None,
            _ if is_full => Some(parse_full(&mut from, DEPTH, &mut left)?),
            _ => Some(parse(&mut from, DEPTH, &mut left)?),
        };
        if left != 0 {
            return Err(invalid("fewer nodes than its header says"));
        }
        Ok(Self { resolution, root })
    }
}

fn invalid(reason: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, reason.into())
}

fn cut_off(error: io::Error) -> io::Error {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => invalid("ends in the middle; it was cut off"),
        _ => error,
    }
}

/// Counts one of the nodes that are left.
fn count(left: &mut usize) -> io::Result<()> {
    *left = left
        .checked_sub(1)
        .ok_or_else(|| invalid("more nodes than its header says"))?;
    Ok(())
}

/// An inner node `depth` levels above voxels, with all below it. `left` nodes are left
/// by the header.
fn parse(from: &mut impl BufRead, depth: u32, left: &mut usize) -> io::Result<Node> {
    if depth == 0 {
        return Err(invalid("a voxel with children"));
    }
    count(left)?;
    let mut bytes = [0; 2];
    from.read_exact(&mut bytes).map_err(cut_off)?;
    let bits = u16::from_le_bytes(bytes);
    let mut children: Box<[Option<Node>; 8]> = Box::default();
    for (i, child) in children.iter_mut().enumerate() {
        *child = match bits >> (2 * i) & 0b11 {
            0b00 => None,
            0b01 => Some(Node::Leaf { occupied: false }),
            0b10 => Some(Node::Leaf { occupied: true }),
            // Its own children follow after all of this node's bits.
            _ => Some(Node::Inner(Box::default())),
        };
    }
    for child in children.iter_mut().flatten() {
        match child {
            Node::Inner(_) => *child = parse(from, depth - 1, left)?,
            Node::Leaf { .. } => count(left)?,
        }
    }
    Ok(Node::Inner(children))
}

/// A node of an `.ot` file `depth` levels above voxels, with all below it.
fn parse_full(from: &mut impl BufRead, depth: u32, left: &mut usize) -> io::Result<Node> {
    count(left)?;
    let mut bytes = [0; 5];
    from.read_exact(&mut bytes).map_err(cut_off)?;
    let [a, b, c, d, has_child] = bytes;
    let odds = f32::from_le_bytes([a, b, c, d]);
    if !odds.is_finite() {
        return Err(invalid(format!("a node with the log-odds {odds}")));
    }
    if has_child == 0 {
        let occupied = odds >= 0.0;
        return Ok(Node::Leaf { occupied });
    }
    if depth == 0 {
        return Err(invalid("a voxel with children"));
    }
    let mut children = Box::new([const { None }; 8]);
    for (i, child) in children.iter_mut().enumerate() {
        if has_child & 1 << i != 0 {
            *child = Some(parse_full(from, depth - 1, left)?);
        }
    }
    Ok(Node::Inner(children))
}

fn insert(node: &mut Option<Node>, key: Voxel, depth: u32, occupied: bool) {
    if depth == 0 {
        *node = Some(Node::Leaf { occupied });
        return;
    }
    let whole = match node {
        Some(Node::Leaf { occupied: known }) if *known == occupied => return,
        Some(Node::Leaf { occupied }) => Some(Node::Leaf {
            occupied: *occupied,
        }),
        _ => None,
    };
    if whole.is_some() || node.is_none() {
        *node = Some(Node::Inner(Box::new(std::array::from_fn(|_| {
            whole.clone()
        }))));
    }
    let Some(Node::Inner(children)) = node else {
        return;
    };
    let i = (0..3)
        .map(|axis| ((key[axis] >> (depth - 1) & 1) as usize) << axis)
        .sum::<usize>();
    insert(&mut children[i], key, depth - 1, occupied);
    // Eight equal leaves are one.
    if children
        .iter()
        .all(|child| *child == Some(Node::Leaf { occupied }))
    {
        *node = Some(Node::Leaf { occupied });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    fn voxels() -> impl Strategy<Value = Vec<(Voxel, bool)>> {
        let axis = -3i32..5;
        let voxel = (axis.clone(), axis.clone(), axis).prop_map(|(x, y, z)| [x, y, z]);
        prop::collection::vec((voxel, any::<bool>()), 0..600)
    }

    proptest! {
        /// Against a plain table, and through a file.
        #[test]
        fn a_tree_is_a_table(voxels in voxels()) {
            let mut tree = OcTree::new(0.5);
            let mut table = BTreeMap::new();
            for &(voxel, occupied) in &voxels {
                tree.insert(voxel, occupied);
                table.insert(voxel, occupied);
            }
            let mut bytes = Vec::new();
            tree.write(&mut bytes).unwrap();
            let tree = OcTree::read(&bytes[..]).unwrap();
            let mut found = BTreeMap::new();
            for cube in tree.cubes() {
                for i in 0..cube.side.pow(3) {
                    let [x, y, z] = cube.corner;
                    let s = cube.side;
                    found.insert([x + i % s, y + i / s % s, z + i / s / s], cube.occupied);
                }
            }
            prop_assert_eq!(found, table);
        }

        #[test]
        fn damaged_files_are_refused_or_read(
            voxels in voxels(), cut in 0usize..400, at in 0usize..400, flip in any::<u8>(),
        ) {
            let mut tree = OcTree::new(0.5);
            for (voxel, occupied) in voxels {
                tree.insert(voxel, occupied);
            }
            let mut bytes = Vec::new();
            tree.write(&mut bytes).unwrap();
            bytes.truncate(cut.max(1));
            let at = at % bytes.len();
            bytes[at] ^= flip;
            let _ = OcTree::read(&bytes[..]);
        }
    }

    /// As OctoMap writes it: a root with two leaves, the first an inner node with one.
    #[test]
    fn odds_above_a_half_are_occupied() {
        let header = format!("{FULL_MAGIC}\nid OcTree\nsize 4\nres 0.5\ndata\n");
        let node = |odds: f32, children: u8| [&odds.to_le_bytes()[..], &[children]].concat();
        let nodes = [
            node(0.8, 0b1001),
            node(0.8, 0b10),
            node(0.85, 0),
            node(-0.4, 0),
        ];
        let file = [header.as_bytes(), &nodes.concat()].concat();
        let half = CENTRE;
        let cube = |corner, side, occupied| Cube {
            corner,
            side,
            occupied,
        };
        let tree = OcTree::read(&file[..]).unwrap();
        assert_eq!(
            tree.cubes(),
            [
                cube([-half / 2, -half, -half], half / 2, true),
                cube([0, 0, -half], half, false),
            ]
        );
        for (nodes, reason) in [
            (nodes[..3].concat(), "middle"),
            (node(f32::NAN, 0), "log-odds NaN"),
            (node(0.0, 1).repeat(4), "more nodes"),
            (node(0.0, 0), "fewer nodes"),
        ] {
            let file = [header.as_bytes(), &nodes].concat();
            let error = OcTree::read(&file[..]).unwrap_err().to_string();
            assert!(error.contains(reason), "{reason:?} is not in {error}");
        }
    }

    #[test]
    fn a_header_is_believed_only_so_far() {
        let error = |bytes: &[u8]| OcTree::read(bytes).unwrap_err().to_string();
        let file = |header: &str, data: &[u8]| {
            let header = format!("{MAGIC}\n{header}\nres 0.1\ndata\n");
            [header.as_bytes(), data].concat()
        };
        let deep = [0x03, 0x00].repeat(40);
        for (bytes, reason) in [
            (file("size 99999999999", &[]), "at most 4194304"),
            (file("size 4000000", &[0xff; 20]), "middle"),
            (file("size 4000000", &deep), "children"),
            (file("size 3", &deep), "more nodes"),
            (file("size 3", &[0x01, 0x00]), "fewer nodes"),
            (file("size -1", &[]), "no size"),
            (file("id ColorOcTree\nsize 1", &[0, 0]), "id OcTree"),
            (file(&"# \n".repeat(3000), &[]), "no data line"),
        ] {
            let error = error(&bytes);
            assert!(error.contains(reason), "{reason:?} is not in {error}");
        }
        // A line without an end is not waited for.
        let endless = io::Read::chain(MAGIC.as_bytes(), io::repeat(b'x'));
        assert!(OcTree::read(io::BufReader::new(endless)).is_err());
    }

    /// One occupied voxel at the origin: sixteen inner nodes, each with one child.
    #[test]
    fn the_bytes_of_one_voxel() {
        let mut tree = OcTree::new(0.25);
        tree.insert([0, 0, 0], true);
        let mut bytes = Vec::new();
        tree.write(&mut bytes).unwrap();
        let header = b"# Octomap OcTree binary file\nid OcTree\nsize 17\nres 0.25\ndata\n";
        let data = [
            // The centre's upper child in all axes, then its lowest ones.
            &[0x00, 0xc0][..],
            &[0x03, 0x00].repeat(14),
            &[0x02, 0x00],
        ];
        assert_eq!(bytes, [&header[..], &data.concat()].concat());
    }
}
