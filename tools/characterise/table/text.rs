//! From bytes to text.

/// The text of a file: UTF-8, or UTF-16 with a byte order mark, as spreadsheets export it. Bytes that are no UTF-8, such as umlauts in
/// older encodings, become replacement characters: names and remarks have them, numbers do not.
///
/// # Errors
/// For bytes that are no text at all.
pub fn decode(bytes: &[u8]) -> Result<String, String> {
    let text = match bytes {
        [0xff, 0xfe, rest @ ..] => from_utf16(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => from_utf16(rest, u16::from_be_bytes),
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8_lossy(rest).into_owned(),
        _ => String::from_utf8_lossy(bytes).into_owned(),
    };
    if bytes.starts_with(b"PK\x03\x04") {
        return Err(
            "a packed file or a spreadsheet (.xlsx, .ods), but must be a table as text: export it as CSV".to_owned()
        );
    }
    match text.find('\0') {
        Some(_) => Err("no text, but must be a table as text, such as CSV".to_owned()),
        None => Ok(text.replace("\r\n", "\n").replace('\r', "\n")),
    }
}

fn from_utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let units: Vec<u16> = bytes.as_chunks::<2>().0.iter().map(|pair| unit(*pair)).collect();
    String::from_utf16_lossy(&units)
}
