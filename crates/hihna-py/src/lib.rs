//! The native part of the Python package `hihna`; what users see is in `python/hihna`.

mod beam;
mod drive;
mod errors;
mod plate;
mod results;
mod space_beam;
mod structure;
mod user_laws;
mod user_motion;

use pyo3::prelude::*;

/// Module `hihna._native`.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("InputError", errors::input_error_type(py)?)?;
    module.add("RunError", py.get_type::<errors::RunError>())?;
    module.add("ReadError", py.get_type::<errors::ReadError>())?;
    module.add("StructureError", py.get_type::<errors::StructureError>())?;
    module.add_class::<drive::NativeDrive>()?;
    module.add_class::<results::NativeResults>()?;
    module.add_class::<beam::NativeBeam>()?;
    module.add_class::<space_beam::NativeSpaceBeam>()?;
    module.add_function(wrap_pyfunction!(space_beam::rectangle, module)?)?;
    module.add_function(wrap_pyfunction!(space_beam::tube, module)?)?;
    module.add_function(wrap_pyfunction!(space_beam::trapezoid, module)?)?;
    module.add_class::<plate::NativePlate>()
}
