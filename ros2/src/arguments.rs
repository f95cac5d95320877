//! The command line as every ROS 2 node has it: `--ros-args -r from:=to -p name:=value
//! --params-file file`.

use std::path::{Path, PathBuf};

use serde_yaml_ng::{Mapping, Value};

/// What the command line and its files say.
#[derive(Debug, PartialEq)]
pub(crate) struct Arguments {
    pub(crate) namespace: String,
    pub(crate) name: String,
    /// Topics to rename: from and to.
    renames: Vec<(String, String)>,
    pub(crate) parameters: Mapping,
    /// What is likely not meant so.
    pub(crate) notes: Vec<String>,
}

/// What is wrong with the command line.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ArgumentError {
    #[error(
        "`{0}` is no argument of this node; it takes what every node takes: `--ros-args -p \
         name:=value -r from:=to --params-file file`. docs/ros2.md has its parameters"
    )]
    Unknown(String),
    #[error("`{0}` wants a value behind it")]
    Missing(String),
    #[error("`{0}` wants `name:=value`, not `{1}`")]
    Assignment(String, String),
    #[error("`{0}` is not written as YAML: {1}")]
    Value(String, serde_yaml_ng::Error),
    #[error("{0} cannot be read: {1}")]
    Unreadable(PathBuf, std::io::Error),
    #[error("{0} is no file of parameters: {1}")]
    File(PathBuf, String),
}

impl Arguments {
    /// Reads them; files are read from where `open` finds them.
    pub(crate) fn parse(
        words: impl IntoIterator<Item = String>,
        open: impl Fn(&Path) -> std::io::Result<String>,
    ) -> Result<Self, ArgumentError> {
        let mut read = Self {
            namespace: "/".to_owned(),
            name: "explore".to_owned(),
            renames: Vec::new(),
            parameters: Mapping::new(),
            notes: Vec::new(),
        };
        let mut files = Vec::new();
        let mut assigned = Vec::new();
        let mut words = words.into_iter();
        while let Some(word) = words.next() {
            let mut value = || {
                let next = words.next();
                next.ok_or_else(|| ArgumentError::Missing(word.clone()))
            };
            match word.as_str() {
                "--ros-args"
                | "--"
                | "--enable-rosout-logs"
                | "--disable-rosout-logs"
                | "--enable-stdout-logs"
                | "--disable-stdout-logs"
                | "--enable-external-lib-logs"
                | "--disable-external-lib-logs" => {}
                "--log-level" | "--log-config-file" | "-e" | "--enclave" => drop(value()?),
                "-p" | "--param" => assigned.push(assignment(&word, value()?)?),
                "-r" | "--remap" => match assignment(&word, value()?)? {
                    (from, to) if from == "__ns" => read.namespace = absolute(&to),
                    (from, to) if from == "__node" || from == "__name" => read.name = to,
                    rename => read.renames.push(rename),
                },
                "--params-file" => files.push(PathBuf::from(value()?)),
                _ => return Err(ArgumentError::Unknown(word)),
            }
        }
        let node = read.node();
        for file in files {
            let text =
                open(&file).map_err(|error| ArgumentError::Unreadable(file.clone(), error))?;
            let no_file = |why: String| ArgumentError::File(file.clone(), why);
            let value: Value =
                serde_yaml_ng::from_str(&text).map_err(|error| no_file(error.to_string()))?;
            let Value::Mapping(nodes) = value else {
                return Err(no_file("it begins with no name of a node".to_owned()));
            };
            let mut others = Vec::new();
            if !collect(&nodes, "", &node, &mut read.parameters, &mut others) {
                let others = match others.as_slice() {
                    [] => "there is no `ros__parameters` in it".to_owned(),
                    others => format!("it has some for {}", others.join(", ")),
                };
                read.notes.push(format!(
                    "{} has no parameters for {node}; {others}. `-r __node:=name` names this node",
                    file.display()
                ));
            }
        }
        for (name, value) in assigned {
            let value = serde_yaml_ng::from_str(&value)
                .map_err(|error| ArgumentError::Value(format!("{name}:={value}"), error))?;
            read.parameters.insert(Value::String(name), value);
        }
        Ok(read)
    }

    /// The node's full name.
    pub(crate) fn node(&self) -> String {
        format!("{}/{}", self.namespace.trim_end_matches('/'), self.name)
    }

    /// The full name of a topic: renamed, and in the node's namespace unless it begins with
    /// a slash.
    pub(crate) fn topic(&self, name: &str) -> String {
        let full = |name: &str| match name.starts_with('/') {
            true => name.to_owned(),
            false => format!("{}/{name}", self.namespace.trim_end_matches('/')),
        };
        let is_meant = |from: &str| from == name || full(from) == full(name);
        let rename = self.renames.iter().find(|(from, _)| is_meant(from));
        full(rename.map_or(name, |(_, to)| to))
    }
}

fn assignment(option: &str, word: String) -> Result<(String, String), ArgumentError> {
    match word.split_once(":=") {
        Some((name, value)) if !name.is_empty() => Ok((name.to_owned(), value.to_owned())),
        _ => Err(ArgumentError::Assignment(option.to_owned(), word)),
    }
}

fn absolute(namespace: &str) -> String {
    format!("/{}", namespace.trim_matches('/'))
}

/// Adds what a file has for the node: under its name, its full name in one or in parts, or
/// `/**`. What comes later counts. Says whether there was any, and adds the names of `others`
/// that the file has parameters for.
fn collect(
    nodes: &Mapping,
    within: &str,
    node: &str,
    into: &mut Mapping,
    others: &mut Vec<String>,
) -> bool {
    let mut has_ours = false;
    for (key, value) in nodes {
        let (Some(key), Value::Mapping(value)) = (key.as_str(), value) else {
            continue;
        };
        if key == "ros__parameters" {
            let is_ours = within == "/**" || within == node || {
                // A name without a namespace is that node wherever it is.
                let name = within.trim_start_matches('/');
                !name.contains('/') && node.rsplit('/').next() == Some(name)
            };
            has_ours |= is_ours;
            if is_ours {
                into.extend(
                    value
                        .iter()
                        .map(|(name, value)| (name.clone(), value.clone())),
                );
            } else {
                others.push(within.to_owned());
            }
        } else {
            let path = format!("{within}/{}", key.trim_start_matches('/'));
            has_ours |= collect(value, &path, node, into, others);
        }
    }
    has_ours
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(words: &str, file: &str) -> Result<Arguments, ArgumentError> {
        let open = |_: &Path| Ok(file.to_owned());
        Arguments::parse(words.split_whitespace().map(str::to_owned), open)
    }

    #[test]
    fn a_launch_file_says_where_the_node_is_and_what_it_knows() {
        let read = parse(
            "--ros-args -r __ns:=/robot2 -r __node:=explore -r scan:=/front/scan \
             -p resolution:=0.25 --log-level info",
            "",
        )
        .unwrap();
        assert_eq!(read.node(), "/robot2/explore");
        assert_eq!(read.topic("scan"), "/front/scan");
        assert_eq!(read.topic("cmd_vel"), "/robot2/cmd_vel");
        assert_eq!(read.topic("/explore/frames"), "/explore/frames");
        assert_eq!(read.parameters["resolution"], Value::from(0.25));
    }

    #[test]
    fn files_have_parameters_for_one_node_or_all_and_the_command_line_wins() {
        let file = "/**:\n  ros__parameters: {width: 10, height: 11, resolution: 1.0}\n\
                    robot2:\n  explore:\n    ros__parameters: {width: 20}\n\
                    /robot3/explore:\n  ros__parameters: {width: 30}\n";
        let of = |robot: u8| {
            let words = "--ros-args --params-file any -p height:=5 -r __ns:=/robot";
            parse(&format!("{words}{robot}"), file).unwrap().parameters
        };
        assert_eq!(of(1)["width"], Value::from(10));
        assert_eq!(of(2)["width"], Value::from(20));
        assert_eq!(of(3)["width"], Value::from(30));
        assert_eq!(of(3)["height"], Value::from(5));
        let of_another = "explore_node:\n  ros__parameters: {width: 10}\n";
        let read = parse("--params-file any -r __ns:=/robot1", of_another).unwrap();
        let [note] = &read.notes[..] else {
            panic!("{:?}", read.notes);
        };
        assert!(
            note.contains("for /robot1/explore; it has some for /explore_node"),
            "{note}"
        );
        let read = parse("--params-file any -r __node:=explore_node", of_another).unwrap();
        assert!(read.notes.is_empty(), "{:?}", read.notes);
        let named = parse(
            "--ros-args --params-file x",
            "explore:\n  ros__parameters: {width: 9}",
        );
        assert_eq!(named.unwrap().parameters["width"], Value::from(9));
    }

    #[test]
    fn mistakes_are_named() {
        for (words, says) in [
            ("--help", "`--help` is no argument"),
            ("--ros-args -p", "`-p` wants a value"),
            (
                "--ros-args -p width=3",
                "wants `name:=value`, not `width=3`",
            ),
            ("--ros-args -p width:=[", "width:=["),
            ("--ros-args --params-file some.yaml", "some.yaml is no file"),
        ] {
            let error = parse(words, "just text").unwrap_err().to_string();
            assert!(error.contains(says), "{words}: {error}");
        }
    }
}
