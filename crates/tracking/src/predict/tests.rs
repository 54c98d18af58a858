//! Square matrices by rows, for the textbook forms of filters with which tests compare.

use std::array::from_fn;

pub(super) type Dense<const N: usize> = [[f64; N]; N];

pub(super) fn identity<const N: usize>() -> Dense<N> {
    from_fn(|i| from_fn(|j| f64::from(i == j)))
}

pub(super) fn transposed<const N: usize>(m: &Dense<N>) -> Dense<N> {
    from_fn(|i| from_fn(|j| m[j][i]))
}

pub(super) fn product<const N: usize>(a: &Dense<N>, b: &Dense<N>) -> Dense<N> {
    from_fn(|i| from_fn(|j| (0..N).map(|k| a[i][k] * b[k][j]).sum()))
}

/// Returns `a + factor b`.
pub(super) fn sum<const N: usize>(a: &Dense<N>, factor: f64, b: &Dense<N>) -> Dense<N> {
    from_fn(|i| from_fn(|j| a[i][j] + factor * b[i][j]))
}

/// Returns the root of the sum of the squares of all elements.
pub(super) fn norm<const N: usize>(m: &Dense<N>) -> f64 {
    m.as_flattened().iter().map(|element| element * element).sum::<f64>().sqrt()
}

/// Returns true if a symmetric matrix has a decomposition of Cholesky.
pub(super) fn is_positive_definite<const N: usize>(m: &Dense<N>) -> bool {
    let mut root: Dense<N> = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..=i {
            let rest = m[i][j] - (0..j).map(|k| root[i][k] * root[j][k]).sum::<f64>();
            if i == j && (rest.is_nan() || rest <= 0.0) {
                return false;
            }
            root[i][j] = if i == j { rest.sqrt() } else { rest / root[j][j] };
        }
    }
    true
}
