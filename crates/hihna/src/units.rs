//! Units at the border: text such as `"81.25 mm"` or `"720 rpm"` becomes a number in SI.
//!
//! `uom` knows the units and their factors. This file adds the spellings that people type
//! (`N m`, `kg m^2`, `deg/s`, `N/m2`) and the few units that `uom` lacks. Inside Hihna a number is SI.

use std::fmt;

use schemars::{Schema, SchemaGenerator, json_schema};

/// A physical dimension of input fields, with the units that can be written for it.
pub struct Dimension {
    /// Name as a reader would say it: `length`.
    pub name: &'static str,
    /// SI unit in which plain numbers are understood; empty for ratios.
    pub unit: &'static str,
    /// A value as it could stand in a file, without quotes: `81.25 mm`.
    pub example: &'static str,
    /// The units most used, for messages.
    pub usual: &'static [&'static str],
    /// More spellings: canonical form, factor, name of the unit in `uom`.
    aliases: &'static [(&'static str, f64, &'static str)],
    /// Value in SI of a number in a unit of `uom`, given by any of its names.
    parse: fn(&str) -> Option<f64>,
    /// Abbreviation, singular and plural of all units of `uom`.
    names: fn() -> Vec<[&'static str; 3]>,
}

impl fmt::Debug for Dimension {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name)
    }
}

impl PartialEq for Dimension {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// Why a text is no quantity of the wanted dimension.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum QuantityError {
    /// The text does not start with a number.
    NoNumber,
    /// A number without unit.
    NoUnit,
    /// A unit that does not belong to the dimension: the unit as written, and the name of the
    /// dimension to which it belongs, if that is known.
    WrongUnit(String, Option<&'static str>),
}

impl Dimension {
    /// Value in SI of a text such as `81.25 mm`.
    pub fn parse(&self, text: &str) -> Result<f64, QuantityError> {
        let (number, unit) = split_number(text.trim());
        let value: f64 = number.parse().map_err(|_| QuantityError::NoNumber)?;
        if unit.is_empty() {
            return Err(QuantityError::NoUnit);
        }
        if let Some(factor) = self.factor(unit) {
            return Ok(scale(value, factor));
        }
        let other = DIMENSIONS.iter().find(|d| d.factor(unit).is_some());
        Err(QuantityError::WrongUnit(
            unit.to_owned(),
            other.map(|d| d.name),
        ))
    }

    /// One of a unit, in SI.
    fn factor(&self, unit: &str) -> Option<f64> {
        let wanted = canonical(unit);
        let mut aliases = self.aliases.iter();
        if let Some((_, factor, name)) = aliases.find(|(alias, ..)| same_unit(alias, &wanted)) {
            return (self.parse)(&format!("{factor} {name}"));
        }
        let words = unit.split_whitespace().collect::<Vec<_>>().join(" ");
        let words = words.replace("metre", "meter");
        let known = |[abbreviation, singular, plural]: &[&str; 3]| {
            !plural.is_empty()
                && (same_unit(&canonical(abbreviation), &wanted)
                    || singular.eq_ignore_ascii_case(&words)
                    || plural.eq_ignore_ascii_case(&words))
        };
        let [.., plural] = (self.names)().into_iter().find(known)?;
        (self.parse)(&format!("1 {plural}"))
    }

    /// The dimension with an article, for messages: `a length`, `an angle`.
    pub fn with_article(&self) -> String {
        let article = if self.name.starts_with(['a', 'e', 'i', 'o', 'u']) {
            "an"
        } else {
            "a"
        };
        format!("{article} {}", self.name)
    }
}

/// `value * factor`; a factor such as a thousandth, which has no exact binary form, becomes a division by
/// its exact inverse, so that `81.25 mm` is the same number as `0.08125`.
fn scale(value: f64, factor: f64) -> f64 {
    let inverse = (1.0 / factor).round();
    if inverse > 1.0 && (inverse * factor - 1.0).abs() < 4.0 * f64::EPSILON {
        value / inverse
    } else {
        value * factor
    }
}

/// Splits `12.5e3 mm` into the number and the rest without leading blanks.
fn split_number(text: &str) -> (&str, &str) {
    let bytes = text.as_bytes();
    let digits_from = |mut i: usize| {
        while bytes.get(i).is_some_and(u8::is_ascii_digit) {
            i += 1;
        }
        i
    };
    let sign_at = |i: usize| usize::from(matches!(bytes.get(i), Some(b'+' | b'-')));
    let mut end = digits_from(sign_at(0));
    if bytes.get(end) == Some(&b'.') {
        end = digits_from(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let exponent = end + 1 + sign_at(end + 1);
        let after = digits_from(exponent);
        if after > exponent {
            end = after;
        }
    }
    // All bytes up to `end` are ASCII, so it is a character boundary.
    let (number, unit) = text.split_at(end);
    (number, unit.trim_start())
}

/// One spelling for all: `kg m^2`, `kg*m²` and `kg · m²` become `kg·m2`.
fn canonical(unit: &str) -> String {
    let mut result = String::new();
    let mut pending_product = false;
    for c in unit.trim().replace("**", "^").chars() {
        let c = match c {
            '*' | '×' | '⋅' | '·' | ' ' | '\t' => {
                pending_product = !result.is_empty();
                continue;
            }
            '^' => continue,
            '²' => '2',
            '³' => '3',
            '₀' => '0',
            'μ' | 'µ' => 'u',
            c => c,
        };
        if pending_product && !matches!(c, '/' | ')') && !result.ends_with(['/', '(']) {
            result.push('·');
        }
        pending_product = false;
        result.push(c);
    }
    if let Some(rest) = result.strip_prefix("deg")
        && (rest.is_empty() || rest.starts_with('/'))
    {
        return format!("°{rest}");
    }
    result
}

/// Whether two canonical units are the same, also where the product's dot is left out: `Nm`.
fn same_unit(known: &str, wanted: &str) -> bool {
    !known.is_empty() && (known == wanted || known.replace('·', "") == *wanted)
}

macro_rules! dimensions {
    ($($(#[$doc:meta])* $function:ident: $quantity:ident in $module:ident, $name:literal, $unit:literal, $example:literal,
        usual [$($usual:literal),*], aliases [$($alias:expr),*];)*) => {
        /// All dimensions of input fields.
        pub static DIMENSIONS: &[Dimension] = &[$(Dimension {
            name: $name,
            unit: $unit,
            example: $example,
            usual: &[$($usual),*],
            aliases: &[$($alias),*],
            parse: |text| text.parse::<uom::si::f64::$quantity>().ok().map(|quantity| quantity.value),
            names: || {
                uom::si::$module::units().map(|u| [u.abbreviation(), u.singular(), u.plural()]).collect()
            },
        }),*];

        $($(#[$doc])*
        pub(crate) fn $function(_: &mut SchemaGenerator) -> Schema {
            quantity_schema($name)
        })*
    };
}

dimensions! {
    /// Schema of a length [m].
    length: Length in length, "length", "m", "81.25 mm",
        usual ["m", "cm", "mm", "µm", "in", "ft"], aliases [];
    /// Schema of a time [s].
    time: Time in time, "time", "s", "0.5 s",
        usual ["s", "ms", "µs", "min"], aliases [("sec", 1.0, "seconds")];
    /// Schema of a force [N].
    force: Force in force, "force", "N", "50 N",
        usual ["N", "kN", "lbf"], aliases [];
    /// Schema of a torque [N m].
    torque: Torque in torque, "torque", "N m", "2.5 N m",
        usual ["N m", "N mm", "kN m", "lbf ft", "lbf in"], aliases [];
    /// Schema of an angle [rad].
    angle: Angle in angle, "angle", "rad", "90 deg",
        usual ["rad", "deg", "rev"],
        aliases [("rev", 1.0, "revolutions"), ("mrad", 1e-3, "radians")];
    /// Schema of an angular velocity [rad/s].
    angular_velocity: AngularVelocity in angular_velocity, "angular velocity", "rad/s", "720 rpm",
        usual ["rad/s", "deg/s", "rpm", "rps"],
        aliases [
            ("rev/min", 1.0, "rpm"), ("r/min", 1.0, "rpm"), ("1/min", 1.0, "rpm"),
            ("rev/s", 1.0, "rps"), ("r/s", 1.0, "rps")
        ];
    /// Schema of a velocity [m/s].
    velocity: Velocity in velocity, "velocity", "m/s", "1 mm/s",
        usual ["m/s", "mm/s", "km/h", "ft/s"], aliases [];
    /// Schema of an acceleration [m/s²].
    acceleration: Acceleration in acceleration, "acceleration", "m/s2", "-9.81 m/s2",
        usual ["m/s2", "mm/s2", "g0"], aliases [];
    /// Schema of a density [kg/m³].
    density: MassDensity in mass_density, "density", "kg/m3", "1.036 g/cm3",
        usual ["kg/m3", "g/cm3", "t/m3"], aliases [("kg/dm3", 1.0, "g/cm³"), ("kg/l", 1.0, "g/cm³")];
    /// Schema of a moment of inertia [kg m²].
    inertia: MomentOfInertia in moment_of_inertia, "moment of inertia", "kg m2", "0.1 kg m2",
        usual ["kg m2", "kg cm2", "kg mm2", "g cm2"],
        aliases [
            ("kg·cm2", 1e-4, "kg · m²"), ("kg·mm2", 1e-6, "kg · m²"), ("g·m2", 1e-3, "kg · m²"),
            ("g·cm2", 1e-7, "kg · m²"), ("g·mm2", 1e-9, "kg · m²"), ("t·m2", 1e3, "kg · m²"),
            ("t·mm2", 1e-3, "kg · m²"), ("lb·ft2", 0.042_140_110_093_804_8, "kg · m²"),
            ("lb·in2", 2.926_396_534_292e-4, "kg · m²")
        ];
    /// Schema of a pressure [Pa].
    pressure: Pressure in pressure, "pressure", "Pa", "100 MPa",
        usual ["Pa", "MPa", "GPa", "N/m2", "N/mm2", "psi"],
        aliases [
            ("N/m2", 1.0, "Pa"), ("kN/m2", 1.0, "kPa"), ("MN/m2", 1.0, "MPa"), ("GN/m2", 1.0, "GPa"),
            ("N/cm2", 1e4, "Pa"), ("kN/mm2", 1.0, "GPa"), ("kN/cm2", 1e7, "Pa")
        ];
    /// Schema of a stiffness per length of belt [N/m²], the dimension of a pressure.
    stiffness_per_length: Pressure in pressure, "stiffness per length", "N/m2", "1e7 N/m2",
        usual ["N/m2", "kN/m2", "N/mm2", "MPa"],
        aliases [("N/m2", 1.0, "Pa"), ("kN/m2", 1.0, "kPa"), ("MN/m2", 1.0, "MPa"), ("N/cm2", 1e4, "Pa")];
    /// Schema of a damping per length of belt [N s/m²], the dimension of a viscosity.
    damping_per_length: DynamicViscosity in dynamic_viscosity, "damping per length", "N s/m2", "10 N s/m2",
        usual ["N s/m2", "kN s/m2", "N s/mm2", "Pa s"],
        aliases [
            ("N·s/m2", 1.0, "Pa · s"), ("kN·s/m2", 1e3, "Pa · s"), ("MN·s/m2", 1e6, "Pa · s"),
            ("N·s/mm2", 1e6, "Pa · s"), ("kPa·s", 1e3, "Pa · s"), ("MPa·s", 1e6, "Pa · s"),
            ("kg/(m·s)", 1.0, "Pa · s")
        ];
    /// Schema of a ratio [-].
    ratio: Ratio in ratio, "ratio", "", "1 %",
        usual ["%", "‰", "ppm"], aliases [];
}

/// Key under which the schema states the dimension of a number.
pub(crate) const QUANTITY: &str = "x-quantity";
/// Key under which the schema states the SI unit of a number.
pub(crate) const UNIT: &str = "x-unit";
/// Dimension of values in a profile before a field lends its own.
const FIELD: &str = "of the field";

/// What contact laws are stated in on a surface, per area of belt, beside the same per length.
static PER_AREA: &[(&str, Dimension)] = &[
    (
        "stiffness per length",
        Dimension {
            name: "stiffness per area",
            unit: "N/m3",
            example: "1e7 N/m3",
            usual: &["N/m3", "kN/m3", "N/mm3"],
            aliases: &[],
            parse: |text| per_area(text, &STIFFNESSES),
            names: || STIFFNESSES.map(|(name, _)| [name; 3]).to_vec(),
        },
    ),
    (
        "damping per length",
        Dimension {
            name: "damping per area",
            unit: "N s/m3",
            example: "2000 N s/m3",
            usual: &["N s/m3", "kN s/m3", "N s/mm3"],
            aliases: &[],
            parse: |text| per_area(text, &DAMPINGS),
            names: || DAMPINGS.map(|(name, _)| [name; 3]).to_vec(),
        },
    ),
];

const STIFFNESSES: [(&str, f64); 4] = [
    ("N/m3", 1.0),
    ("kN/m3", 1.0e3),
    ("MN/m3", 1.0e6),
    ("N/mm3", 1.0e9),
];
const DAMPINGS: [(&str, f64); 3] = [("N s/m3", 1.0), ("kN s/m3", 1.0e3), ("N s/mm3", 1.0e9)];

/// Value in SI of a number in one of `units`, for which the crate of units has no quantity.
fn per_area(text: &str, units: &[(&str, f64)]) -> Option<f64> {
    let (number, unit) = split_number(text);
    let (_, factor) = units.iter().find(|(name, _)| *name == unit)?;
    Some(number.parse::<f64>().ok()? * factor)
}

impl Dimension {
    /// The same per area of belt, of a dimension per length of belt.
    pub fn per_area(&self) -> Option<&'static Self> {
        let found = PER_AREA.iter().find(|(name, _)| *name == self.name);
        found.map(|(_, dimension)| dimension)
    }
}

/// The dimension of that name.
pub fn dimension(name: &str) -> Option<&'static Dimension> {
    DIMENSIONS.iter().find(|dimension| dimension.name == name)
}

/// What text of a quantity looks like: a number and something behind it that no longer belongs to it. Which units
/// there are a schema cannot say.
const TEXT: &str =
    r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?(\s+\S|[^\s0-9.eE]|[eE][^\s0-9+-])";

fn quantity_schema(name: &str) -> Schema {
    let dimension = dimension(name);
    json_schema!({
        "type": ["number", "string"],
        "pattern": TEXT,
        QUANTITY: name,
        UNIT: dimension.map_or("", |d| d.unit),
    })
}

/// Schema of a value whose dimension is that of the field in which it stands.
pub(crate) fn of_the_field(_: &mut SchemaGenerator) -> Schema {
    quantity_schema(FIELD)
}

/// Schema of a list of values whose dimension is that of the field in which it stands.
pub(crate) fn list_of_the_field(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "array", "items": quantity_schema(FIELD), "minItems": 1 })
}

/// Schema of a list of times [s].
pub(crate) fn times(generator: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "array", "items": time(generator) })
}

/// Schema of a point in the plane [m].
pub(crate) fn point(generator: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "array", "items": length(generator), "minItems": 2, "maxItems": 2 })
}

/// Schema of a list of angular velocities [rad/s].
pub(crate) fn angular_velocities(generator: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "array", "items": angular_velocity(generator), "minItems": 1 })
}

/// Schema of a list of torques [N m].
pub(crate) fn torques(generator: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "array", "items": torque(generator), "minItems": 1 })
}

/// Schema of an acceleration in the plane [m/s²].
pub(crate) fn acceleration_vector(generator: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "array", "items": acceleration(generator), "minItems": 2, "maxItems": 2 })
}

/// The schema `profile` with values of the dimension of `quantity`.
pub(crate) fn lend_dimension(profile: &mut serde_json::Value, quantity: &Schema) {
    match profile {
        serde_json::Value::Object(map) if map.get(QUANTITY).is_some_and(|name| name == FIELD) => {
            if let Some(lent) = quantity.as_object() {
                map.extend(lent.clone());
            }
        }
        serde_json::Value::Object(map) => map
            .values_mut()
            .for_each(|value| lend_dimension(value, quantity)),
        serde_json::Value::Array(list) => list
            .iter_mut()
            .for_each(|value| lend_dimension(value, quantity)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Friendly spellings, each with its value in SI to round-off of two multiplications.
    #[test]
    fn spellings() {
        let cases = [
            ("length", "81.25 mm", 0.08125),
            ("length", "81.25mm", 0.08125),
            ("length", "+1e1 um", 1e-5),
            ("length", "1275 mm", 1.275),
            ("length", "2 metres", 2.0),
            ("length", "1 in", 0.0254),
            ("time", "2 ms", 2e-3),
            ("time", "1 minute", 60.0),
            ("torque", "2 N m", 2.0),
            ("torque", "2 N*m", 2.0),
            ("torque", "2 N·m", 2.0),
            ("torque", "2 Nm", 2.0),
            ("torque", "2 kNm", 2000.0),
            ("torque", "2 Nmm", 0.002),
            ("torque", "-2 newton meters", -2.0),
            ("moment of inertia", "0.1 kg m2", 0.1),
            ("moment of inertia", "0.1 kg m^2", 0.1),
            ("moment of inertia", "0.1 kg·m²", 0.1),
            ("moment of inertia", "0.1 kg*m**2", 0.1),
            ("moment of inertia", "0.1 kgm2", 0.1),
            ("moment of inertia", "5 kg cm²", 5e-4),
            ("angular velocity", "60 rpm", std::f64::consts::TAU),
            ("angular velocity", "60 rev/min", std::f64::consts::TAU),
            ("angular velocity", "12 rad/s", 12.0),
            ("angular velocity", "180 deg/s", std::f64::consts::PI),
            ("angle", "180 deg", std::f64::consts::PI),
            ("angle", "180°", std::f64::consts::PI),
            ("angle", "1 rev", std::f64::consts::TAU),
            ("density", "1.036 g/cm3", 1036.0),
            ("density", "1036 kg/m^3", 1036.0),
            ("pressure", "100 MPa", 1e8),
            ("pressure", "100 N/mm2", 1e8),
            ("pressure", "1e7 N/m²", 1e7),
            ("pressure", "2 GPa", 2e9),
            ("damping per length", "10 N s/m2", 10.0),
            ("damping per length", "10 Ns/m^2", 10.0),
            ("damping per length", "10 Pa s", 10.0),
            ("ratio", "1 %", 0.01),
            ("ratio", "1%", 0.01),
            ("force", "1.5 kN", 1500.0),
            ("velocity", "36 km/h", 10.0),
            ("acceleration", "9.81 m/s^2", 9.81),
            ("acceleration", "1 g0", 9.80665),
        ];
        for (name, text, expected) in cases {
            let value = dimension(name)
                .unwrap()
                .parse(text)
                .unwrap_or_else(|e| panic!("{text}: {e:?}"));
            assert!(
                (value - expected).abs() <= 1e-14 * expected.abs(),
                "{text}: {value}"
            );
        }
    }

    /// Decimal units give the number that a reader would write in SI.
    #[test]
    fn decimal_units_are_exact() {
        let read = |name: &str, text: &str| dimension(name).unwrap().parse(text);
        assert_eq!(read("length", "81.25 mm"), Ok(0.08125));
        assert_eq!(read("length", "1275 mm"), Ok(1.275));
        assert_eq!(read("length", "191.441 mm"), Ok(0.191_441));
        assert_eq!(read("ratio", "0.3 %"), Ok(0.003));
        assert_eq!(read("time", "0.1 ms"), Ok(0.0001));
        assert_eq!(read("moment of inertia", "7 kg cm2"), Ok(0.0007));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let length = dimension("length").unwrap();
        assert_eq!(length.parse("5"), Err(QuantityError::NoUnit));
        assert_eq!(length.parse("five mm"), Err(QuantityError::NoNumber));
        assert_eq!(
            length.parse("5 N"),
            Err(QuantityError::WrongUnit("N".into(), Some("force")))
        );
        assert_eq!(
            length.parse("5 bananas"),
            Err(QuantityError::WrongUnit("bananas".into(), None))
        );
        assert_eq!(
            dimension("ratio").unwrap().parse("0.5"),
            Err(QuantityError::NoUnit)
        );
        for text in [
            "", " ", "-", "+.", ".", "1e", "é", "1é", "nan m", "inf m", "e5 m",
        ] {
            assert!(length.parse(text).is_err(), "{text}");
        }
    }

    /// Every unit of the messages and every example can be read, and no spelling has two meanings.
    #[test]
    fn units_are_unambiguous() {
        let per_area = PER_AREA.iter().map(|(_, dimension)| dimension);
        for dimension in DIMENSIONS.iter().chain(per_area) {
            assert!(
                dimension.parse(dimension.example).is_ok(),
                "{}",
                dimension.example
            );
            assert!(
                dimension.unit.is_empty()
                    || dimension.parse(&format!("1 {}", dimension.unit)) == Ok(1.0)
            );
            for unit in dimension.usual {
                assert!(dimension.parse(&format!("1 {unit}")).is_ok(), "{unit}");
            }
            let mut seen = std::collections::BTreeMap::new();
            for [abbreviation, .., plural] in (dimension.names)() {
                let value = (dimension.parse)(&format!("1 {plural}"));
                let first = *seen
                    .entry(canonical(abbreviation).replace('·', ""))
                    .or_insert(value);
                assert_eq!(first, value, "{}: {abbreviation}", dimension.name);
            }
        }
    }
}
