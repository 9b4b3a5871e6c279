//! Numbers with units, as people read them: four digits and a prefix.

/// Prefixes with their factors, largest first.
const PREFIXES: [(f64, &str); 7] = [
    (1e9, "G"),
    (1e6, "M"),
    (1e3, "k"),
    (1.0, ""),
    (1e-3, "m"),
    (1e-6, "µ"),
    (1e-9, "n"),
];

/// `12.34 kN` of 12340 and `N`.
pub fn with_prefix(value: f64, unit: &str) -> String {
    let magnitude = value.abs();
    // Half a unit of the fourth digit more, so that 0.99999 is 1 and not 1000 thousandths.
    let fitting = PREFIXES
        .iter()
        .find(|(factor, _)| magnitude * 1.00005 >= *factor);
    match fitting {
        Some((factor, prefix)) => format!("{} {prefix}{unit}", digits(value / factor)),
        None => format!("{} {unit}", digits(value)),
    }
}

/// `12.34 rad/s` of 12.341 and `rad/s`.
pub fn plain(value: f64, unit: &str) -> String {
    format!("{} {unit}", digits(value))
}

/// `0.281 %` of 0.00281.
pub fn percent(value: f64) -> String {
    plain(100.0 * value, "%")
}

/// `12.34°` of 0.2154.
pub fn degrees(angle: f64) -> String {
    // Without the sign of a negative zero.
    format!("{:.2}°", (100.0 * angle.to_degrees()).round() / 100.0 + 0.0)
}

/// `12.34` of 12.341.
pub fn significant(value: f64) -> String {
    digits(value)
}

/// Four significant digits, or the whole number if that has more.
fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        // Without the sign of a negative zero.
        return (value + 0.0).to_string();
    }
    // Rounding may carry: the exponent is that of the rounded number.
    let scientific = format!("{value:.3e}");
    let exponent = scientific
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    match exponent.and_then(|exponent| usize::try_from(3 - exponent.min(3)).ok()) {
        Some(decimals) if decimals <= 7 => format!("{value:.decimals$}"),
        _ => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(with_prefix(0.08125, "m"), "81.25 mm");
        assert_eq!(with_prefix(1e8, "Pa"), "100.0 MPa");
        assert_eq!(with_prefix(-12_340.0, "N"), "-12.34 kN");
        assert_eq!(with_prefix(0.999_999, "s"), "1.000 s");
        assert_eq!(with_prefix(0.0, "N m"), "0 N m");
        assert_eq!(with_prefix(-0.0, "N m"), "0 N m");
        assert_eq!(with_prefix(3e-12, "N"), "3.000e-12 N");
        assert_eq!(with_prefix(5e12, "N"), "5000 GN");
        assert_eq!(with_prefix(f64::NAN, "N"), "NaN N");
        assert_eq!(plain(12.0, "rad/s"), "12.00 rad/s");
        assert_eq!(plain(123_456.7, "rad/s"), "123457 rad/s");
        assert_eq!(percent(0.002_807), "0.2807 %");
    }
}
