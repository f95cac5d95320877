//! `fixtures/budget.txt`: what the planners and the image may take.
//!
//! Read by `cargo xtask test` for the image, and by `tests/budget.rs` for the
//! sizes of types.

use std::path::Path;

/// The limits, in the order of the file.
pub(crate) struct Budget(pub(crate) Vec<(String, u64)>);

impl Budget {
    /// Reads `fixtures/budget.txt` below the folder of the workspace.
    pub(crate) fn read(root: &Path) -> Result<Self, String> {
        let path = root.join("fixtures/budget.txt");
        let text = std::fs::read_to_string(&path)
            .map_err(|error| format!("{}: {error}", path.display()))?;
        Self::parse(&text).map_err(|error| format!("{}: {error}", path.display()))
    }

    fn parse(text: &str) -> Result<Self, String> {
        let lines = text
            .lines()
            .zip(1..)
            .map(|(line, number)| (line.split('#').next().unwrap_or_default().trim(), number));
        lines
            .filter(|(line, _)| !line.is_empty())
            .map(|(line, number)| {
                line.split_once("<=")
                    .and_then(|(name, limit)| {
                        Some((name.trim().to_owned(), limit.trim().parse().ok()?))
                    })
                    .ok_or_else(|| {
                        format!("line {number}: expected `name <= number`, found `{line}`")
                    })
            })
            .collect::<Result<_, _>>()
            .map(Self)
    }

    /// Holds what was measured against the limits whose names begin with
    /// `prefix`: none may be exceeded, and each must have been measured.
    /// Returns one line for each measure.
    pub(crate) fn check(
        &self,
        prefix: &str,
        measured: &[(&str, u64)],
    ) -> Result<Vec<String>, String> {
        for (name, _) in self.0.iter().filter(|(name, _)| name.starts_with(prefix)) {
            if !measured.iter().any(|(measure, _)| measure == name) {
                return Err(format!(
                    "fixtures/budget.txt limits {name}, which nothing measures"
                ));
            }
        }
        measured
            .iter()
            .map(
                |&(name, size)| match self.0.iter().find(|(limited, _)| limited == name) {
                    None => Err(format!(
                        "{name} is {size}; give it a limit in fixtures/budget.txt"
                    )),
                    Some(&(_, limit)) if size > limit => Err(format!(
                        "{name} is {size}, above the {limit} of fixtures/budget.txt; \
                     make it smaller, or raise the limit if it is worth that"
                    )),
                    Some((_, limit)) => Ok(format!("{name} {size} of {limit}")),
                },
            )
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Budget;

    #[test]
    fn limits_are_held() {
        let budget = Budget::parse("# comment\n\na_bytes <= 10 # why\nb_bytes<=3\n").unwrap();
        assert_eq!(
            budget.check("a_", &[("a_bytes", 10)]).unwrap(),
            ["a_bytes 10 of 10"]
        );
        assert!(budget.check("a_", &[("a_bytes", 11)]).is_err());
        assert!(
            budget.check("a_", &[("c_bytes", 1)]).is_err(),
            "no such limit"
        );
        assert!(
            budget.check("", &[("a_bytes", 1)]).is_err(),
            "b is not measured"
        );
    }

    #[test]
    fn a_bad_line_is_named() {
        let error = Budget::parse("a <= 1\nb = 2\n").err().unwrap();
        assert_eq!(error, "line 2: expected `name <= number`, found `b = 2`");
    }
}
