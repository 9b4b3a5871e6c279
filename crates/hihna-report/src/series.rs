//! Columns of the history made short enough to draw.

/// Rows up to which a column is drawn as it is.
const MOST: usize = 3000;

/// The points of a curve, thinned if there are more than eyes can tell apart: of every stretch of rows its least and
/// its greatest value stay, in order, so that no peak is lost.
pub fn thinned(x: &[f64], y: &[f64]) -> (Vec<f32>, Vec<f32>) {
    let count = x.len().min(y.len());
    let kept: Vec<usize> = if count <= MOST {
        (0..count).collect()
    } else {
        let length = count.div_ceil(MOST / 2);
        let mut kept: Vec<usize> = (0..count)
            .step_by(length)
            .flat_map(|start| extremes(y, start, (start + length).min(count)))
            .collect();
        kept.dedup();
        kept
    };
    kept.into_iter().map(|i| (short(x[i]), short(y[i]))).unzip()
}

/// Places of the least and the greatest value of a stretch, in order; its start if it has no number.
fn extremes(y: &[f64], start: usize, end: usize) -> [usize; 2] {
    let numbers = || (start..end).filter(|i| y[*i].is_finite());
    let least = numbers().min_by(|a, b| y[*a].total_cmp(&y[*b]));
    let greatest = numbers().max_by(|a, b| y[*a].total_cmp(&y[*b]));
    let (a, b) = (least.unwrap_or(start), greatest.unwrap_or(start));
    [a.min(b), a.max(b)]
}

/// Seven digits are more than a screen shows.
#[expect(clippy::cast_possible_truncation, reason = "the point of it")]
pub fn short(value: f64) -> f32 {
    value as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a long column a single peak and a single pit stay, and the order of the times.
    #[test]
    fn peaks_stay() {
        let x: Vec<f64> = (0..100_000).map(f64::from).collect();
        let mut y = vec![0.0; x.len()];
        (y[54_321], y[54_322], y[7]) = (1.0, -1.0, f64::NAN);
        let (x, y) = thinned(&x, &y);
        assert!(y.len() <= MOST + 2);
        assert!(y.contains(&1.0) && y.contains(&-1.0));
        assert!(x.is_sorted());
    }

    #[test]
    fn short_and_empty_columns_are_kept() {
        assert_eq!(
            thinned(&[0.0, 1.0], &[2.0, 3.0]),
            (vec![0.0, 1.0], vec![2.0, 3.0])
        );
        assert_eq!(thinned(&[], &[]), (Vec::new(), Vec::new()));
        let (_, y) = thinned(&vec![0.0; 10_000], &vec![f64::NAN; 10_000]);
        assert!(y.iter().all(|y| y.is_nan()));
    }
}
