//! Normals of a file with any length become unit normals with the same direction.

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use pxpl5_scene::{Format, Placement, Scene, from_bytes, placed_from_bytes};

/// Returns a triangle whose corners have the normal given as text.
fn obj(normal: &str) -> String {
    format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn {normal}\nf 1//1 2//1 3//1\n")
}

/// Returns the same triangle as a PLY file with normals in double precision.
fn ply(normal: &str) -> String {
    let corners: String = ["0 0 0", "1 0 0", "0 1 0"].map(|place| format!("{place} {normal}\n")).concat();
    let properties: String = ["x", "y", "z", "nx", "ny", "nz"].map(|name| format!("property double {name}\n")).concat();
    format!(
        "ply\nformat ascii 1.0\nelement vertex 3\n{properties}element face 1\nproperty list uchar int vertex_indices\nend_header\n\
         {corners}3 0 1 2\n"
    )
}

/// Checks that a normal has length 1 within single precision, as required for every vertex.
fn assert_direction(scene: &Scene, expected: DVec3) {
    for vertex in scene.vertices() {
        let normal = vertex.normal.as_dvec3();
        assert!((normal.length() - 1.0).abs() < 1e-6 && (normal - expected).length() < 1e-6, "{normal} for {expected}");
    }
}

/// Returns the expected unit normal: the given vector divided by its largest component, then by its length. For a
/// vector without length it is the triangle's own normal.
fn direction(text: &str) -> DVec3 {
    let numbers: Vec<f64> = text.split(' ').map(|word| word.parse().expect("a number")).collect();
    let v = DVec3::from_slice(&numbers);
    let scaled = v / v.abs().max_element();
    if v == DVec3::ZERO { DVec3::Z } else { scaled / scaled.length() }
}

fn check(normal: &str) {
    for (format, text) in [(Format::Obj, obj(normal)), (Format::Ply, ply(normal))] {
        let scene = from_bytes(text.as_bytes(), format, "test").unwrap_or_else(|error| panic!("{normal}: {error}"));
        assert_direction(&scene, direction(normal));
        let placed = placed_from_bytes(text.as_bytes(), format, "test", Placement::AsInFile).expect("as above");
        assert_direction(&placed, direction(normal));
    }
}

#[test]
fn the_direction_of_a_normal_is_exact_for_a_normal_of_any_length() {
    // The square of 3e-162 is not 0, but a subnormal number with a single bit.
    check("3e-162 0 0");
    for exponent in -330..=15 {
        let largest = if exponent == 15 { "1e15" } else { "" };
        let number = if largest.is_empty() { format!("-7.3e{exponent}") } else { largest.to_owned() };
        check(&format!("{number} 0 0"));
        check(&format!("0 {number} {number}"));
    }
}

#[test]
fn triangles_of_any_size_have_a_normal() {
    for exponent in -160..=14 {
        let text = format!("v 0 0 0\nv 1e{exponent} 0 0\nv 0 0 -1e{exponent}\nf 1 2 3\n");
        let scene = placed_from_bytes(text.as_bytes(), Format::Obj, "test", Placement::AsInFile).expect("sound");
        assert!(scene.vertices().iter().all(|vertex| vertex.normal == Vec3::Y), "1e{exponent}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_normal_with_components_of_different_size_has_the_correct_direction(
        mantissas in prop::array::uniform3(-9.99..9.99),
        exponents in prop::array::uniform3(-330..14),
    ) {
        let words: Vec<String> = mantissas.iter().zip(exponents).map(|(m, e)| format!("{m}e{e}")).collect();
        check(&words.join(" "));
    }
}
