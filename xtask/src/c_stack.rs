//! How much of the stack each function of the library for C takes at most: added up over
//! all chains of calls in the code itself, whatever the input.
//!
//! That is possible because the code has no recursion and no call by pointer; both are
//! looked for.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};

use crate::c_interface;
use crate::shell::{self, command};

/// Every function of the header says how many bytes of stack it takes, and takes no more;
/// nor does it say much more than it takes.
pub(crate) fn keeps_to_the_header(object: &Path) -> Result<()> {
    let header = fs::read_to_string(shell::root().join(c_interface::HEADER))?;
    let code = Code::of(object, &c_interface::functions(&header))?;
    let mut wrong = Vec::new();
    println!("bytes of stack     at most   of");
    for (name, stated) in stated(&header)? {
        let most = code.most(name)?;
        println!("{name:<26}{most:>5} {stated:>5}");
        if most > stated || stated > most.next_multiple_of(STEP) + 3 * STEP {
            wrong.push(format!("{name} takes {most} bytes, not {stated}"));
        }
    }
    if !wrong.is_empty() {
        bail!(
            "{}; correct `Stack:` in c-api/src, then run `cargo xtask c-header`",
            wrong.join(", ")
        );
    }
    Ok(())
}

/// What the header says is rounded up to a multiple of this.
const STEP: u32 = 128;

/// The functions of a header, and what their comments say after `Stack: `.
fn stated(header: &str) -> Result<Vec<(&str, u32)>> {
    let mut said = None;
    let mut stated = Vec::new();
    for line in header.lines() {
        if let Some((_, bytes)) = line.split_once("Stack: ") {
            let bytes = bytes.split_once(' ').map_or(bytes, |(bytes, _)| bytes);
            said = Some(bytes.parse().with_context(|| line.to_owned())?);
        }
        if let [name] = c_interface::functions(line)[..] {
            let bytes = said.take();
            stated.push((
                name,
                bytes.with_context(|| format!("{name} says nothing of its stack"))?,
            ));
        }
    }
    Ok(stated)
}

/// The functions of an image, by name.
#[derive(Debug, Default)]
struct Code(BTreeMap<String, Function>);

/// What one function does to the stack.
#[derive(Debug, Default)]
struct Function {
    /// Bytes that it takes itself.
    own: u32,
    calls: BTreeSet<String>,
}

impl Code {
    /// The code of an object that is linked for itself: every call then says where to.
    fn of(object: &Path, functions: &[&str]) -> Result<Self> {
        let image = object.with_extension("elf");
        command("arm-none-eabi-ld")
            .args(["--gc-sections", "--entry=planner_create"])
            .args(functions.iter().map(|name| format!("--undefined={name}")))
            .arg(object)
            .arg("-o")
            .arg(&image)
            .run()?;
        let listing = command("arm-none-eabi-objdump")
            .args(["--disassemble", "--no-show-raw-insn"])
            .arg(&image)
            .output()?;
        if !listing.success() {
            bail!("{}: {}", image.display(), listing.stderr);
        }
        Self::read(&listing.stdout)
    }

    fn read(listing: &str) -> Result<Self> {
        let mut code = Self::default();
        let mut name = String::new();
        for line in listing.lines() {
            if let Some((_, label)) = line.split_once(" <").filter(|_| line.ends_with(">:")) {
                name = label.trim_end_matches(">:").to_owned();
                code.0.entry(name.clone()).or_default();
                continue;
            }
            let mut words = line.split('\t').skip(1);
            let (Some(operation), operands) = (words.next(), words.next().unwrap_or_default())
            else {
                continue;
            };
            let function = code.0.entry(name.clone()).or_default();
            let problem = || format!("{name}: {}", line.trim());
            function.own += taken(operation.trim(), operands).with_context(problem)?;
            if let Some(called) = called(operation.trim(), operands).with_context(problem)?
                && called != name
            {
                function.calls.insert(called.to_owned());
            }
        }
        Ok(code)
    }

    /// What a function takes, with everything that it calls.
    fn most(&self, name: &str) -> Result<u32> {
        let mut path = Vec::new();
        let mut known = BTreeMap::new();
        self.depth(name, &mut path, &mut known)
    }

    fn depth<'a>(
        &'a self,
        name: &'a str,
        path: &mut Vec<&'a str>,
        known: &mut BTreeMap<&'a str, u32>,
    ) -> Result<u32> {
        if let Some(&depth) = known.get(name) {
            return Ok(depth);
        }
        if path.contains(&name) {
            bail!("{name} calls itself: {}", path.join(", "));
        }
        let function = self
            .0
            .get(name)
            .with_context(|| format!("no function {name}"))?;
        path.push(name);
        let mut below = 0;
        for called in &function.calls {
            below = below.max(self.depth(called, path, known)?);
        }
        path.pop();
        let depth = function.own + below;
        known.insert(name, depth);
        Ok(depth)
    }
}

/// Bytes that one instruction takes of the stack.
fn taken(operation: &str, operands: &str) -> Result<u32> {
    let number = || {
        let (_, number) = operands.rsplit_once('#')?;
        let end = number.find(|it: char| !it.is_ascii_digit() && it != '-');
        number[..end.unwrap_or(number.len())].parse::<i32>().ok()
    };
    let registers = operands.split_once('{').map_or(0, |(_, list)| {
        let list = list.trim_end().trim_end_matches('}');
        list.split(", ")
            .map(|part| part.split_once('-').map_or(1, span))
            .sum()
    });
    let is_on_stack = operands.starts_with("sp");
    let bytes = match operation.split_once('.').map_or(operation, |(it, _)| it) {
        "push" => 4 * registers,
        "stmdb" if operands.starts_with("sp!") => 4 * registers,
        "vpush" if operands.contains('d') => 8 * registers,
        "vpush" => 4 * registers,
        "sub" | "subw" if is_on_stack => number().context("not by a number")?.unsigned_abs(),
        "str" | "strd" if operands.contains("[sp, #-") && operands.ends_with("]!") => {
            number().context("not by a number")?.unsigned_abs()
        }
        "mov" | "msr" if is_on_stack => bail!("moves the stack"),
        "add" if is_on_stack && number().is_none() => bail!("moves the stack"),
        _ => 0,
    };
    Ok(bytes)
}

/// Registers in a range such as `r4-r7`.
fn span((first, last): (&str, &str)) -> u32 {
    let number = |it: &str| it[1..].parse::<u32>().unwrap_or_default();
    number(last).saturating_sub(number(first)) + 1
}

/// The function that a branch leads to.
fn called<'a>(operation: &str, operands: &'a str) -> Result<Option<&'a str>> {
    let stem = operation.split_once('.').map_or(operation, |(it, _)| it);
    if stem.starts_with("blx") || (stem.starts_with("bx") && operands.trim() != "lr") {
        bail!("a call by pointer");
    }
    if !stem.starts_with('b') && !stem.starts_with("cb") {
        return Ok(None);
    }
    let label = operands
        .split_once('<')
        .and_then(|(_, it)| it.split_once('>'));
    Ok(label.map(|(label, _)| label.split_once('+').map_or(label, |(name, _)| name)))
}

#[cfg(test)]
mod tests {
    use super::{Code, stated};

    const LISTING: &str = "\
00008000 <planner_tick>:
    8000:\tpush\t{r4, r5, r6, r7, lr}
    8002:\tstmdb\tsp!, {r8, r9, sl, fp}
    8006:\tvpush\t{d8-d9}
    800a:\tsub.w\tsp, sp, #1024\t@ 0x400
    800e:\tbl\t8100 <deeper>
    8012:\tbhi.n\t800e <planner_tick+0xe>
    8014:\tb.w\t8200 <other>

00008100 <deeper>:
    8100:\tstr.w\tfp, [sp, #-4]!
    8104:\tstr.w\tfp, [sp, #4]
    8108:\tbx\tlr

00008200 <other>:
    8200:\tsub\tsp, #64\t@ 0x40
    8204:\tbx\tlr
";

    #[test]
    fn the_deepest_chain_is_found() {
        let code = Code::read(LISTING).unwrap();
        assert_eq!(code.most("deeper").unwrap(), 4);
        assert_eq!(code.most("planner_tick").unwrap(), 20 + 16 + 16 + 1024 + 64);
        code.most("nobody").unwrap_err();
    }

    #[test]
    fn what_cannot_be_added_up_is_refused() {
        let round = "00008000 <a>:\n 8000:\tbl\t8100 <b>\n00008100 <b>:\n 8100:\tb.n\t8000 <a>\n";
        Code::read(round).unwrap().most("a").unwrap_err();
        Code::read("00008000 <a>:\n 8000:\tblx\tr3\n").unwrap_err();
        Code::read("00008000 <a>:\n 8000:\tsub.w\tsp, sp, r4\n").unwrap_err();
    }

    #[test]
    fn a_header_says_what_it_takes() {
        let header =
            "// Ticks.\n//\n// Stack: 128 bytes.\nPlannerResult planner_tick(Planner *it);\n";
        assert_eq!(stated(header).unwrap(), [("planner_tick", 128)]);
        stated("void planner_tick(Planner *it);\n").unwrap_err();
    }
}
