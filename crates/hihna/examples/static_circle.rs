//! A belt off its pulleys springs to a circle (Kerkkänen 2006, Figs 3.4 and 3.5): the shape before every
//! iteration and at the end, as CSV.
//!
//! `cargo run --release --example static_circle -- examples/figure_3_5.toml`

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args().nth(1);
    let file = file.as_deref().unwrap_or("examples/figure_3_5.toml");
    let drive = hihna::input::load(Path::new(file), &[])?;
    let free = hihna::free_belt::spring_free(&drive)?;
    println!("iteration,point,x,y");
    for (iteration, shape) in free.shapes.iter().enumerate() {
        for (point, [x, y]) in shape.iter().enumerate() {
            println!("{iteration},{point},{x:.9},{y:.9}");
        }
    }
    Ok(())
}
