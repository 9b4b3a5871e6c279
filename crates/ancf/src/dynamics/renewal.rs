//! Whether a stage begins with a new tangent.
//!
//! With an old factor a stage needs more evaluations, and where it fails after all, the trials made with it are
//! lost; a new one costs as much as [`TANGENT`] evaluations. Which is cheaper depends on how many contacts come and go
//! in a step, so both are tried: the mean cost of the last stages of either kind decides, and the other kind is
//! tried again from time to time, unless it cannot be cheaper.

/// Evaluations (force, residual and solution) that take as long as a tangent with its factor.
const TANGENT: f64 = 5.0;
/// The least that a stage with a new tangent costs: it begins with an evaluation and ends with another.
const LEAST: f64 = 2.0 + TANGENT;
/// Part of the last stage in the mean cost.
const NEWS: f64 = 1.0 / 32.0;
/// Stages from one try of the other kind to the next, and how many of them are such tries.
const PERIOD: usize = 256;
const TRIES: usize = 8;

/// The account of both kinds of stages.
#[derive(Clone, Debug, Default)]
pub(super) struct Renewal {
    /// Mean cost of a stage with the old factor and with a new one, in evaluations; zero for none yet.
    costs: [f64; 2],
    /// Stages since the last tries began.
    stages: usize,
}

impl Renewal {
    /// Whether the next stage begins with a new tangent.
    pub(super) fn is_due(&self) -> bool {
        let [old, new] = self.costs;
        if old <= LEAST {
            return false;
        }
        let new_is_cheaper = new > 0.0 && new < old;
        new_is_cheaper != (self.stages < TRIES)
    }

    /// Takes in what a stage cost that began with a new tangent or not.
    pub(super) fn count(&mut self, began_new: bool, evaluations: usize, tangents: usize) {
        let cost = evaluations as f64 + TANGENT * tangents as f64;
        let mean = &mut self.costs[usize::from(began_new)];
        let news = if *mean > 0.0 { NEWS } else { 1.0 };
        *mean += news * (cost - *mean);
        self.stages = (self.stages + 1) % PERIOD;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many of `stages` stages begin with a new tangent, if those with the old factor take `old` evaluations and as many tangents, and the
    /// others `new`.
    fn renewed(stages: usize, old: (usize, usize), new: (usize, usize)) -> usize {
        let mut renewal = Renewal::default();
        let mut renewed = 0;
        for _ in 0..stages {
            let due = renewal.is_due();
            renewed += usize::from(due);
            let (evaluations, tangents) = if due { new } else { old };
            renewal.count(due, evaluations, tangents);
        }
        renewed
    }

    /// Old factors where they are cheap, without any try where nothing could be cheaper; new tangents where old factors fail often; the other
    /// kind in 8 of 256 stages.
    #[test]
    fn the_cheaper_kind_is_taken() {
        assert_eq!(renewed(25_600, (4, 0), (2, 1)), 0);
        let tried = renewed(25_600, (8, 0), (4, 1));
        assert!((700..=800).contains(&tried), "{tried}");
        let tried = 25_600 - renewed(25_600, (8, 1), (3, 1));
        assert!((700..=900).contains(&tried), "{tried}");
    }
}
