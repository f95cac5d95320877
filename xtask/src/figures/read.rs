//! Numbers in text, and tables of them.

use std::ops::Range;

use anyhow::{Context, Result, bail, ensure};

use super::list::Tolerance;

/// A number, and where it stands in its text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Number {
    pub(super) value: f64,
    pub(super) decimals: usize,
    pub(super) place: Range<usize>,
}

/// Numbers that belong together: of a sentence, or of a cell; and the text between.
#[derive(Debug, PartialEq)]
pub(super) struct Found {
    pub(super) numbers: Vec<Number>,
    pub(super) words: String,
    /// What a message calls it.
    pub(super) name: String,
    /// The whole of it.
    pub(super) place: Range<usize>,
}

/// What a pattern stands for in a text: one sentence, or all cells of one table.
///
/// A pattern that begins in a table's head is that of the table: what stands before its
/// first `|` is in the line above, and its cells are the first ones of the head. They are
/// the key of a row. In other patterns `{}` is a number, `…` anything in the same line, and
/// `……` anything.
pub(super) fn find(pattern: &str, text: &str) -> Result<Vec<Found>> {
    if is_head(pattern) {
        return cells(pattern, text);
    }
    let mut found = Vec::new();
    for (begin, _) in text.char_indices() {
        found.extend(sentence(pattern, text, begin));
    }
    ensure!(!found.is_empty(), "`{pattern}` is not there");
    ensure!(
        found.len() == 1,
        "`{pattern}` is there {} times",
        found.len()
    );
    Ok(found)
}

/// Whether a pattern is that of a table.
pub(super) fn is_head(pattern: &str) -> bool {
    pattern.ends_with('|') && !pattern.contains("{}")
}

/// The pattern where `begin` is in the text. Runs of white space are one.
fn sentence(pattern: &str, text: &str, begin: usize) -> Option<Found> {
    let mut numbers = Vec::new();
    let mut at = begin;
    let mut rest = pattern;
    while let Some(next) = rest.chars().next() {
        if let Some(after) = rest.strip_prefix("{}") {
            let number = number(text, at)?;
            at = number.place.end;
            numbers.push(number);
            rest = after;
        } else if let Some(after) = rest.strip_prefix('…') {
            let (after, end) = match after.strip_prefix('…') {
                Some(after) => (after, None),
                None => (after, text[at..].find('\n')),
            };
            let end = end.map_or(text.len(), |end| at + end);
            let ends = text[at..end].char_indices().map(|(offset, _)| at + offset);
            let tail = ends
                .chain([end])
                .find_map(|end| sentence(after, text, end))?;
            numbers.extend(tail.numbers);
            at = tail.place.end;
            rest = "";
        } else if next.is_whitespace() {
            rest = rest.trim_start();
            let after = text[at..].trim_start();
            if after.len() == text[at..].len() {
                return None;
            }
            at = text.len() - after.len();
        } else {
            text[at..].strip_prefix(next)?;
            at += next.len_utf8();
            rest = &rest[next.len_utf8()..];
        }
    }
    Some(Found {
        numbers,
        words: String::new(),
        name: pattern.to_owned(),
        place: begin..at,
    })
}

/// The number that begins at this place.
fn number(text: &str, begin: usize) -> Option<Number> {
    let before = text[..begin].trim_end_matches([',', '.']);
    if before.len() + 1 >= begin && before.ends_with(|it: char| it.is_ascii_digit()) {
        return None; // it began before
    }
    let mut digits = String::new();
    let mut end = begin;
    let mut decimals = None;
    let mut rest = text[begin..].chars().peekable();
    if let Some(sign) = rest.next_if(|it| ['+', '-', '−'].contains(it)) {
        end += sign.len_utf8();
        digits.extend((sign != '+').then_some('-'));
    }
    rest.peek().filter(|it| it.is_ascii_digit())?;
    while let Some(next) = rest.next() {
        let leads_on = rest.peek().is_some_and(char::is_ascii_digit);
        match (next, &mut decimals) {
            ('0'..='9', None) => digits.push(next),
            ('0'..='9', Some(decimals)) => {
                *decimals += 1;
                digits.push(next);
            }
            (',', None) if leads_on => {}
            ('.', None) if leads_on => {
                decimals = Some(0);
                digits.push(next);
            }
            _ => break,
        }
        end += 1;
    }
    Some(Number {
        value: digits.parse().ok()?,
        decimals: decimals.unwrap_or(0),
        place: begin..end,
    })
}

/// All numbers of a part of a text. What is joined to a letter is a name.
fn numbers(text: &str, part: Range<usize>) -> (Vec<Number>, String) {
    let (mut numbers, mut words) = (Vec::new(), String::new());
    let mut at = part.start;
    let mut is_name = false;
    while let Some(next) = text[at..part.end].chars().next() {
        match number(text, at).filter(|it| !is_name && it.place.end <= part.end) {
            Some(number) => {
                at = number.place.end;
                numbers.push(number);
                words.push('#');
            }
            None => {
                words.extend((!next.is_whitespace()).then_some(next));
                at += next.len_utf8();
                is_name = next.is_alphanumeric() || (is_name && next == '-');
            }
        }
    }
    (numbers, words)
}

/// A table of Markdown: cells as places in the text.
#[derive(Debug)]
pub(super) struct Table {
    /// The line above.
    title: String,
    /// The head first.
    rows: Vec<Vec<Range<usize>>>,
    places: Vec<Range<usize>>,
}

/// All tables of a text.
pub(super) fn tables(text: &str) -> Vec<Table> {
    let mut tables: Vec<Table> = Vec::new();
    let mut title = "";
    let mut is_in_table = false;
    let mut begin = 0;
    for line in text.split_inclusive('\n') {
        let place = begin..begin + line.len();
        begin = place.end;
        let trimmed = line.trim();
        if !trimmed.starts_with('|') {
            is_in_table = false;
            if !trimmed.is_empty() {
                title = trimmed;
            }
            continue;
        }
        if !is_in_table {
            tables.push(Table {
                title: title.to_owned(),
                rows: Vec::new(),
                places: Vec::new(),
            });
            is_in_table = true;
        }
        let is_rule = trimmed.chars().all(|it| "|-: ".contains(it));
        if let Some(table) = tables.last_mut().filter(|_| !is_rule) {
            table.rows.push(row(text, place.clone()));
            table.places.push(place);
        }
    }
    tables
}

fn row(text: &str, line: Range<usize>) -> Vec<Range<usize>> {
    let bars = text[line.clone()].match_indices('|');
    let bars: Vec<usize> = bars.map(|(offset, _)| line.start + offset).collect();
    bars.windows(2).map(|pair| pair[0] + 1..pair[1]).collect()
}

impl Table {
    /// Rows with numbers: with a cell behind the first that has nothing else, or any number
    /// at all.
    pub(super) fn figures(&self, text: &str, any: bool) -> Vec<Range<usize>> {
        let has_digit = |cell: &str| cell.contains(|it: char| it.is_ascii_digit());
        let is_figure = |cell: &Range<usize>| {
            let cell = &text[cell.clone()];
            has_digit(cell) && !cell.contains(char::is_alphabetic)
        };
        let rows = self.rows.iter().zip(&self.places).skip(1);
        rows.filter(|(cells, place)| match any {
            true => has_digit(&text[(*place).clone()]),
            false => cells.iter().skip(1).any(is_figure),
        })
        .map(|(_, place)| place.clone())
        .collect()
    }

    /// Whether the table is meant by a pattern.
    pub(super) fn is(&self, pattern: &str, text: &str) -> bool {
        let (title, head) = pattern.split_once('|').unwrap_or_default();
        let head = head.trim_end_matches('|').split('|').map(str::trim);
        let own = self.rows[0].iter().map(|cell| text[cell.clone()].trim());
        let has_head = head.clone().count() <= self.rows[0].len()
            && head.zip(own).all(|(wanted, own)| wanted == own);
        has_head && self.title.contains(title.trim())
    }
}

/// The cells of the table that is meant by a pattern, but for those of its keys.
fn cells(pattern: &str, text: &str) -> Result<Vec<Found>> {
    let tables: Vec<Table> = tables(text)
        .into_iter()
        .filter(|it| it.is(pattern, text))
        .collect();
    let [table] = &tables[..] else {
        bail!("there are {} tables `{pattern}`", tables.len());
    };
    let keys = pattern.matches('|').count() - 1;
    let said = |cell: &Range<usize>| text[cell.clone()].trim().to_owned();
    let mut found = Vec::new();
    for row in &table.rows[1..] {
        let key: Vec<String> = row.iter().take(keys).map(said).collect();
        for (head, cell) in table.rows[0].iter().zip(row).skip(keys) {
            let (numbers, words) = numbers(text, cell.clone());
            found.push(Found {
                numbers,
                words,
                name: format!("{}, {}", key.join(", "), said(head)),
                place: cell.clone(),
            });
        }
    }
    Ok(found)
}

/// The rows of all tables that are meant by a pattern.
pub(super) fn rows(pattern: &str, text: &str) -> Result<Vec<Range<usize>>> {
    let tables = tables(text)
        .into_iter()
        .filter(|table| table.is(pattern, text));
    let rows: Vec<Range<usize>> = tables.flat_map(|table| table.places).collect();
    ensure!(!rows.is_empty(), "there is no table `{pattern}`");
    Ok(rows)
}

/// How a document would be right: a place, and what should stand there.
pub(super) type Correction = (Range<usize>, String);

/// Holds what a document tells against what was measured. `Err`: they cannot be compared.
pub(super) fn compare(
    told: &[Found],
    measured: &[Found],
    tolerance: Tolerance,
) -> Result<Vec<Correction>> {
    let mut corrections = Vec::new();
    for (place, told) in told.iter().enumerate() {
        // A sentence is worded otherwise in the document.
        let measured = match told.words.is_empty() && told.name.contains("{}") {
            true => measured.get(place),
            false => measured.iter().find(|it| it.name == told.name),
        };
        let measured = measured.with_context(|| format!("nothing measures `{}`", told.name))?;
        let (own, its) = (&told.numbers, &measured.numbers);
        ensure!(
            own.len() == its.len() && told.words == measured.words,
            "`{}` is of another form where it is measured: {} numbers, `{}`",
            told.name,
            its.len(),
            measured.words
        );
        let near = own.first().map_or(0.0, |first| first.value.abs());
        let most = f64::max(tolerance.absolute, tolerance.share * near);
        for (own, its) in own.iter().zip(its) {
            // As exact as the document.
            let rounded = format!("{:.*}", own.decimals, its.value);
            let distance = (rounded.parse::<f64>()? - own.value).abs();
            if distance > most * (1.0 + 1e-9) {
                corrections.push((own.place.clone(), rounded));
            }
        }
    }
    Ok(corrections)
}

/// The number as its document writes it: thousands and the sign.
pub(super) fn as_before(before: &str, rounded: &str) -> String {
    let (minus, digits) = match rounded.strip_prefix('-') {
        Some(digits) => (true, digits),
        None => (false, rounded),
    };
    let (whole, rest) = digits.split_at(digits.find('.').unwrap_or(digits.len()));
    let mut text = String::new();
    for (place, digit) in whole.chars().enumerate() {
        if place > 0 && (whole.len() - place) % 3 == 0 && before.contains(',') {
            text.push(',');
        }
        text.push(digit);
    }
    let sign = match (minus, before.chars().next()) {
        (true, Some('−')) => "−",
        (true, _) => "-",
        (false, Some('+')) => "+",
        (false, _) => "",
    };
    format!("{sign}{text}{rest}")
}

#[cfg(test)]
mod tests {
    use super::{Tolerance, as_before, compare, find, tables};

    fn values(pattern: &str, text: &str) -> Vec<f64> {
        let found = find(pattern, text).unwrap();
        found
            .into_iter()
            .flat_map(|it| it.numbers)
            .map(|it| it.value)
            .collect()
    }

    #[test]
    fn sentences_are_found() {
        let text = "It took\n  1,234.5 s,  all of them −3 °C.";
        assert_eq!(values("took {} s, … {} °C", text), [1234.5, -3.0]);
        assert!(find("took {} min", text).is_err());
        assert!(find("{} s", "1 s, 2 s").is_err(), "which one?");
        assert_eq!(values("{} s", "12,345.67 s"), [12345.67]);
    }

    #[test]
    fn lines_may_be_left_out() {
        let text = "a 1\nb\nd\nc 2\n";
        assert_eq!(values("a {} …… c {}", text), [1.0, 2.0]);
        assert!(find("a {} … c {}", text).is_err());
        assert_eq!(values("a {} … d c {}", text), [1.0, 2.0]);
    }

    #[test]
    fn tables_are_compared_by_the_names_of_rows_and_columns() {
        let told = "Ticks:\n\n| map | m | a | b |\n|---|---|---|---|\n| x-1 | 3 | 0.90 ±0.01 | 5 (10 %) |\n";
        let measured = "| map | m | b | a |\n|---|\n| y | 1 | 0 (1 %) | 0 ±1 |\n| x-1 | 3 | 5 (11 %) | 0.912 ±0.01 |\n";
        let tolerance = |share| Tolerance {
            share,
            absolute: 0.0,
        };
        let found = |text| find("| map | m |", text).unwrap();
        let corrections = |share| compare(&found(told), &found(measured), tolerance(share));
        let corrections = |share| -> Vec<String> {
            corrections(share)
                .unwrap()
                .into_iter()
                .map(|(_, it)| it)
                .collect()
        };
        assert_eq!(corrections(0.0), ["0.91", "11"]);
        assert_eq!(corrections(0.02), ["11"]);
        assert!(corrections(0.2).is_empty());
        let other = "| map | m | a | b |\n|---|\n| x-1 | 3 | 0.9 ±0.01 | 5 |\n";
        assert!(compare(&found(told), &found(other), tolerance(1.0)).is_err());
        assert!(find("Metres: | map |", told).is_err());
        assert!(find("Ticks: | map |", told).is_ok());
    }

    #[test]
    fn rows_with_figures_are_known() {
        let text = "| a | b |\n|---|---|\n| 1 | up to 8 |\n| x | 8 % |\n";
        let tables = tables(text);
        let rows = |any| tables[0].figures(text, any).len();
        assert_eq!((rows(false), rows(true)), (1, 2));
    }

    #[test]
    fn numbers_keep_their_form() {
        assert_eq!(as_before("12,345", "1234567"), "1,234,567");
        assert_eq!(as_before("+1.2", "3.4"), "+3.4");
        assert_eq!(as_before("−1.2", "-3.4"), "−3.4");
    }
}
