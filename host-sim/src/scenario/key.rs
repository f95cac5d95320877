//! The fleet's secret as an option.

use planner_core::radio::Key;

/// 32 hex digits, or the name of a file that holds nothing else.
///
/// # Errors
/// In words, without the secret.
pub(super) fn parse(text: &str) -> Result<Key, String> {
    if let Some(key) = of_hex(text) {
        return Ok(key);
    }
    let content = std::fs::read(text).map_err(|error| {
        format!(
            "neither 32 hex digits nor a file that can be read ({error}); `openssl rand -hex 16` writes a new key"
        )
    })?;
    let content = str::from_utf8(&content).ok();
    content
        .and_then(|content| of_hex(content.trim()))
        .ok_or_else(|| "the file does not hold 32 hex digits and nothing else".into())
}

fn of_hex(text: &str) -> Option<Key> {
    let digits: Vec<u8> = text
        .chars()
        .map(|digit| digit.to_digit(16).map(|digit| digit as u8))
        .collect::<Option<_>>()?;
    let bytes: Vec<u8> = digits
        .as_chunks::<2>()
        .0
        .iter()
        .map(|[high, low]| high << 4 | low)
        .collect();
    let key = bytes.try_into().ok().filter(|_| digits.len() == 32);
    key.map(Key)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_is_32_hex_digits_or_a_file_of_them() {
        let hex = "000102030405060708090a0b0c0d0E0F";
        let key = Key(std::array::from_fn(|byte| byte as u8));
        assert!(parse(hex) == Ok(key));
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("key");
        std::fs::write(&file, format!("{hex}\n")).unwrap();
        assert!(parse(file.to_str().unwrap()) == Ok(key));
        for wrong in ["00", &hex[..31], &format!("{hex}0"), "ä"] {
            std::fs::write(&file, wrong).unwrap();
            assert!(parse(file.to_str().unwrap()).is_err());
            assert!(parse(wrong).is_err_and(|text| text.contains("32 hex digits")));
        }
    }
}
