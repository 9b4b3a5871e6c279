//! The running belt as its material points see it: coordinates and velocities for a mesh that travels.
//!
//! At time zero the nodes of a travelling mesh lie where those of the mesh at rest are, and the belt has the velocity
//! `c R'`. That is no motion that the elements can make, R' being no polynomial of their kind: they take the nearest
//! by kinetic energy,
//!
//! ```text
//! M v = c int rho A N N'^T + rho I2 H H'^T dxi e = (c/2) G e
//! ```
//!
//! with the mass matrix M and the gyroscopic G of [`super::modes`]: by parts, `int N N'^T` is skew on a closed belt. Every
//! momentum that the elements can express is that of `c R'`.

use ancf::linear::{BorderedMatrix, CyclicSolver, Solver};

use super::{Running, RunningBelt, RunningError};
use crate::assemble::BeltElementType;

impl<E: BeltElementType> RunningBelt<E> {
    /// Nodal coordinates and velocities of the material points of `running`, on a mesh that travels with them from here.
    pub(crate) fn material_motion(
        &self,
        running: &Running,
    ) -> Result<(Vec<f64>, Vec<f64>), RunningError> {
        let equations = &self.equations;
        let structure = equations.structure();
        let chain = equations.chain();
        let mut mass = BorderedMatrix::new(structure);
        equations.mesh.add_mass(&mut mass);
        for row in chain..structure.size() {
            mass.set_unit_row(row);
        }
        let mut solver = CyclicSolver::new(structure);
        solver.factor(&mass).map_err(|_| RunningError::Singular)?;
        let mut coordinates = running.state.clone();
        coordinates[chain..].fill(0.0);
        let mut velocities = vec![0.0; structure.size()];
        let mut gyroscopic = BorderedMatrix::new(structure);
        (equations.inertia).add_gyroscopic(0.5 * running.circulation, &mut gyroscopic);
        gyroscopic.multiply(&coordinates, &mut velocities);
        solver.solve(&mut velocities);
        coordinates.truncate(chain);
        velocities.truncate(chain);
        Ok((coordinates, velocities))
    }
}
