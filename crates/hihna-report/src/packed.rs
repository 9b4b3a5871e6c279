//! Numbers packed into the page.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// Numbers as 32-bit floats, little-endian, in base64.
pub fn text(values: &[f32]) -> String {
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    STANDARD.encode(bytes)
}
