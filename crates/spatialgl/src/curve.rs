//! The intersection of a triangle with the plane of a slice.

/// The two ends of a triangle's intersection with a plane, and the weights of the triangle's corners at each end.
pub(crate) type PlaneCurve = ([[f64; 3]; 2], [[f64; 3]; 2]);

/// Returns the two ends of a triangle's intersection with its slice, and the weights of the triangle's corners at each
/// end. Returns `None` if the triangle does not cross the slice or lies in the slice.
pub(crate) fn plane_curve(corners: [[f64; 3]; 3]) -> Option<PlaneCurve> {
    let side = corners.map(|corner| corner[2]);
    if side == [0.0; 3] {
        return None;
    }
    let mut ends = [[0.0; 3]; 2];
    let mut weights = [[0.0; 3]; 2];
    let mut found = 0;
    // Exactly two sides cross the plane. Find the crossing on each.
    for i in 0..3 {
        let j = (i + 1) % 3;
        let crosses = (side[i] < 0.0) != (side[j] < 0.0);
        if crosses && found < 2 {
            let t = side[i] / (side[i] - side[j]);
            ends[found] = [0, 1, 2].map(|c| corners[i][c] * (1.0 - t) + corners[j][c] * t);
            weights[found][i] = 1.0 - t;
            weights[found][j] = t;
            found += 1;
        }
    }
    (found == 2).then_some((ends, weights))
}
