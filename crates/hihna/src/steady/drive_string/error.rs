//! Why a drive has no steady running to ask for, and which field of it to change.

use crate::drive::{Belt, Drive};
use crate::input::{FieldPath, Problem};
use crate::layout::LayoutError;
use crate::steady::string::StringError;

/// Why a drive has no steady running to ask for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SteadyError {
    /// The pulleys cannot carry the belt.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// No pulley is driven.
    #[error(
        "no pulley has a `speed`: exactly one must, the others turn by the belt and their `torque`"
    )]
    NoSpeed,
    /// Several pulleys are driven.
    #[error(
        "pulleys \"{first}\" and \"{second}\" both have a `speed`: steady running needs exactly one; give the other its `torque`"
    )]
    SeveralSpeeds {
        /// Name of the one.
        first: String,
        /// Name of another.
        second: String,
    },
    /// A pulley has both speed and torque.
    #[error(
        "pulley \"{pulley}\" has a `speed` and a `torque` of {torque} N m: drop one, the torque of a pulley of given speed is found"
    )]
    SpeedAndTorque {
        /// Name of the pulley.
        pulley: String,
        /// Its torque [N m].
        torque: f64,
    },
    /// A pulley is driven by its angle.
    #[error("pulley \"{pulley}\" is driven by its `angle`: give its `speed` for steady running")]
    AngleDriven {
        /// Name of the pulley.
        pulley: String,
    },
    /// The speed of a pulley is not steady.
    #[error("pulley \"{pulley}\" turns with an `irregularity`: steady running needs an even speed")]
    Irregular {
        /// Name of the pulley.
        pulley: String,
    },
    /// The belt has internal damping.
    #[error(
        "the belt has a `damping_time` of {time} s, which steady running of the finite elements does not take into account"
    )]
    Damped {
        /// The time [s].
        time: f64,
    },
    /// The belt is one of plates.
    #[error("steady running of the finite elements is there for planar elements only")]
    Spatial,
    /// A pulley is moved.
    #[error(
        "pulley \"{pulley}\" has a `displacement`: steady running of the finite elements needs fixed centres"
    )]
    Displaced {
        /// Name of the pulley.
        pulley: String,
    },
    /// Nothing but friction could fix a speed.
    #[error(
        "the belt has no friction on pulley \"{pulley}\": nothing fixes the speed of the one by the other"
    )]
    NoFriction {
        /// Name of the pulley.
        pulley: String,
    },
    /// The driven pulley ends at rest.
    #[error(
        "the speed of pulley \"{pulley}\" ends with {speed} rad/s: steady running needs one that turns"
    )]
    AtRest {
        /// Name of the pulley.
        pulley: String,
        /// The final value [rad/s].
        speed: f64,
    },
    /// A load depends on the speed.
    #[error(
        "the `load` of pulley \"{pulley}\" depends on its speed: the string theory takes a constant `torque`"
    )]
    SpeedDependent {
        /// Name of the pulley.
        pulley: String,
    },
    /// The belt's length is not given.
    #[error("the belt has none of `length`, `tension`, `strain`: give one")]
    NoTightness,
    /// A quantity of a pulley is out of its range.
    #[error("the {quantity} of pulley \"{pulley}\" is {value}: it must be {wanted}")]
    OutOfRange {
        /// The quantity with its unit.
        quantity: &'static str,
        /// Name of the pulley.
        pulley: String,
        /// Its value, SI.
        value: f64,
        /// What it must be.
        wanted: &'static str,
    },
    /// Anything else that the theory refuses.
    #[error(transparent)]
    String(StringError),
}

impl SteadyError {
    /// What is wrong with `drive` at which of its fields, and what to change.
    pub fn problem(&self, drive: &Drive) -> Problem {
        let (path, help) = self.place_and_help(drive);
        Problem::new(path, self.to_string()).help(help)
    }

    fn place_and_help(&self, drive: &Drive) -> (FieldPath, &'static str) {
        let pulleys = FieldPath::default().field("pulley");
        let of_pulley = |name: &str| {
            let index = drive.pulley.iter().position(|pulley| pulley.name == *name);
            index.map_or(pulleys.clone(), |i| pulleys.item(i, Some(name)))
        };
        match self {
            Self::Layout(_) => (
                pulleys,
                "`hihna check` prints the path of the belt once it closes",
            ),
            Self::NoSpeed => (pulleys, "add `speed = \"720 rpm\"` to one pulley"),
            Self::SeveralSpeeds { second, .. } => (
                of_pulley(second).field("speed"),
                "how much each of them pulls is not decided by speeds alone",
            ),
            Self::SpeedAndTorque { pulley, .. } => (
                of_pulley(pulley).field("torque"),
                "the torque that keeps the speed is a result",
            ),
            Self::SpeedDependent { pulley } => (
                of_pulley(pulley).field("load"),
                "give the `torque` at the speed at which the pulley will run; `hihna run` takes the load",
            ),
            Self::AngleDriven { pulley } => (
                of_pulley(pulley).field("angle"),
                "replace `angle` by `speed`, such as `speed = \"720 rpm\"`",
            ),
            Self::Irregular { pulley } => (
                of_pulley(pulley).field("irregularity"),
                "drop it, or let `hihna run` step through time",
            ),
            Self::Spatial => (
                FieldPath::default().field("belt").field("element"),
                "take `belt-beam`, or let `hihna run` step through time",
            ),
            Self::Displaced { pulley } => (
                of_pulley(pulley).field("displacement"),
                "give the `center` where it ends",
            ),
            Self::NoFriction { .. } => (
                FieldPath::default().field("contact").field("friction"),
                "give a coefficient of friction above zero",
            ),
            Self::Damped { .. } => (
                FieldPath::default().field("belt").field("damping_time"),
                "set it to 0, or let `hihna run` step through time",
            ),
            Self::AtRest { pulley, .. } => (
                of_pulley(pulley).field("speed"),
                "the last value of a profile counts; give a speed, such as `speed = \"720 rpm\"`",
            ),
            Self::NoTightness => (
                FieldPath::default().field("belt"),
                "give the unstretched `length`, or `tension = \"50 N\"`, or `strain = 0.01`",
            ),
            Self::OutOfRange {
                quantity, pulley, ..
            } => (
                pulley_field(&of_pulley(pulley), quantity),
                "`hihna check` prints wraps and spans",
            ),
            Self::String(StringError::OutOfRange { quantity, .. }) => (
                belt_field(&drive.belt, quantity),
                "check the belt's numbers for slips of the decimal point",
            ),
            Self::String(_) => (
                FieldPath::default(),
                "`hihna check` prints the layout of the drive",
            ),
        }
    }
}

/// The field behind a quantity of a pulley.
fn pulley_field(pulley: &FieldPath, quantity: &str) -> FieldPath {
    let begins = |word: &str| quantity.starts_with(word);
    if begins("radius") {
        pulley.field("radius")
    } else if begins("torque") {
        pulley.field("torque")
    } else if begins("speed") {
        pulley.field("speed")
    } else if begins("friction") {
        let contact = FieldPath::default().field("contact");
        contact.field("friction").field("coefficient")
    } else {
        pulley.clone()
    }
}

/// The field behind a quantity of the belt.
fn belt_field(belt: &Belt, quantity: &str) -> FieldPath {
    let path = FieldPath::default().field("belt");
    let tightness = match (belt.length, belt.tension) {
        (Some(_), _) => "length",
        (_, Some(_)) => "tension",
        _ => "strain",
    };
    if quantity.starts_with("axial stiffness") {
        path.field("youngs_modulus")
    } else if quantity.starts_with("line density") {
        path.field("density")
    } else {
        path.field(tightness)
    }
}
