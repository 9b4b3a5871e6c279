//! Shape functions of plates at the places where the sections of a belt are read.

use std::num::NonZeroUsize;

use ancf::element::{Element, SurfaceElement, ThinPlate};
use ancf::quadrature::Rule;

/// Gauss points across an element for the axial force of a section: it is of degree 9 in y at most.
pub(super) const ACROSS: usize = 5;
/// Coordinates of a plate.
pub(super) const DOF: usize = ThinPlate::DOF;
/// Its coordinates that are vectors.
pub(super) const VECTORS: usize = DOF / 3;

/// Shape functions of one kind of plate at the contact points along it: on the line that is shown, and at Gauss
/// points across.
#[derive(Clone, Debug)]
pub(super) struct SectionTable {
    /// Position and r_x, r_y on the line, by contact point.
    pub(super) line: Vec<[[f64; VECTORS]; 3]>,
    /// Position on the edges of an element, by contact point.
    pub(super) edges: Vec<[[f64; VECTORS]; 2]>,
    /// r_x, r_y at the Gauss points, by contact point.
    pub(super) across: Vec<[[[f64; VECTORS]; 2]; ACROSS]>,
    /// Weights of the Gauss points times the width [m].
    pub(super) widths: [f64; ACROSS],
}

/// Tables by kind of plate.
#[derive(Clone, Debug, Default)]
pub(super) struct SectionTables(Vec<(ThinPlate, SectionTable)>);

impl SectionTables {
    pub(super) fn of(&mut self, element: &ThinPlate, rule: &Rule, eta: f64) -> &SectionTable {
        let known = self.0.iter().position(|(known, _)| known == element);
        let place = known.unwrap_or_else(|| {
            let table = SectionTable::new(element, rule, eta);
            self.0.push((element.clone(), table));
            self.0.len() - 1
        });
        &self.0[place].1
    }
}

impl SectionTable {
    fn new(element: &ThinPlate, rule: &Rule, eta: f64) -> Self {
        let gauss = Rule::gauss(NonZeroUsize::new(ACROSS).unwrap_or(NonZeroUsize::MIN));
        let slopes = |place: [f64; 2]| {
            let mut slopes = [[0.0; VECTORS]; 2];
            let [by_x, by_y] = &mut slopes;
            element.surface_slopes(place, by_x, by_y);
            slopes
        };
        Self {
            line: (rule.points.iter())
                .map(|xi| {
                    let mut shape = [0.0; VECTORS];
                    element.surface([*xi, eta], &mut shape);
                    let [by_x, by_y] = slopes([*xi, eta]);
                    [shape, by_x, by_y]
                })
                .collect(),
            edges: (rule.points.iter())
                .map(|xi| {
                    [0.0, 1.0].map(|eta| {
                        let mut shape = [0.0; VECTORS];
                        element.surface([*xi, eta], &mut shape);
                        shape
                    })
                })
                .collect(),
            across: (rule.points.iter())
                .map(|xi| std::array::from_fn(|m| slopes([*xi, gauss.points[m]])))
                .collect(),
            widths: std::array::from_fn(|m| gauss.weights[m] * element.width()),
        }
    }
}
