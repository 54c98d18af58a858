//! Files as other programs write them, with rare features of the formats and with common violations of the formats.

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use pxpl5_scene::config::{DEFAULT_COLOUR, IMPORT_RADIUS_M};
use pxpl5_scene::{Format, Placement, Scene, from_bytes, placed_from_bytes};
use pxpl5_sim::parameters::{FileError, FileErrorKind};

/// Returns the scene with the coordinates of its file, so that expected values equal the file's values.
fn read(format: Format, bytes: impl AsRef<[u8]>) -> Result<Scene, FileError> {
    placed_from_bytes(bytes.as_ref(), format, "test", Placement::AsInFile)
}

fn obj(bytes: impl AsRef<[u8]>) -> Scene {
    read(Format::Obj, bytes).unwrap_or_else(|error| panic!("{error}"))
}

fn ply(bytes: impl AsRef<[u8]>) -> Scene {
    read(Format::Ply, bytes).unwrap_or_else(|error| panic!("{error}"))
}

fn corners(scene: &Scene, triangle: [u32; 3]) -> [DVec3; 3] {
    triangle.map(|corner| scene.vertices()[corner as usize].position.as_dvec3())
}

fn areas(scene: &Scene) -> Vec<DVec3> {
    let area = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a) / 2.0;
    scene.triangles().iter().map(|triangle| area(corners(scene, *triangle))).collect()
}

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

// Order and continuation of lines.

#[test]
fn faces_of_obj_may_come_first_and_a_line_that_ends_in_a_backslash_continues_on_the_next_line() {
    let plain = obj(TETRAHEDRON);
    for (from, to) in [
        ("f 1 3 2\n", "f 1 3 \\\n2\n"),
        ("f 1 3 2\n", "f 1 3\\\n 2\n"),
        ("f 1 3 2\n", "f \\\n1 \\\n3 \\\n2\n"),
        ("f 1 3 2\n", "f 1 3 \\\r\n2\r\n"),
        ("f 1 3 2\n", "f\t1\t3\t\\ \n\t2\n"),
        ("v 0 0 0\n", "v 0 0 \\\n 0\n"),
        ("v 0 0 1\n", "v 0 0 1 \\\n\n"),
        ("f 1 3 2\n", "f -4 -2 \\\n -3\n"),
        ("f 3 1 4\n", "f 3 1 \\\n4 \\"),
    ] {
        let text = TETRAHEDRON.replace(from, to);
        assert_ne!(text, TETRAHEDRON);
        assert_eq!(obj(&text), plain, "{to:?}");
    }
    // A comment does not continue.
    assert_eq!(obj(format!("# C:\\models\\\n{TETRAHEDRON}")), plain);
    // Faces may precede the points.
    let (points, faces) = TETRAHEDRON.split_at(TETRAHEDRON.find('f').expect("a face"));
    assert_eq!(obj(format!("{faces}{points}")), plain);
    assert_eq!(obj(TETRAHEDRON.replace("f 1 3 2\n", "f 1 3 \\\n2\n").replace('\n', "\r")), plain);
}

/// Header and rows of the two elements of a tetrahedron: vertices, then faces.
const ELEMENTS: [[&str; 2]; 2] = [
    ["element vertex 4\nproperty float x\nproperty float y\nproperty float z\n", "0 0 0\n1 0 0\n0 1 0\n0 0 1\n"],
    ["element face 4\nproperty list uchar int vertex_indices\n", "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"],
];

fn ascii_ply(order: &[[&str; 2]]) -> String {
    let headers: String = order.iter().map(|[header, _]| *header).collect();
    let rows: String = order.iter().map(|[_, rows]| *rows).collect();
    format!("ply\nformat ascii 1.0\n{headers}end_header\n{rows}")
}

#[test]
fn elements_of_ply_may_come_in_any_order() {
    let [vertices, faces] = ELEMENTS;
    let plain = ply(ascii_ply(&[vertices, faces]));
    assert_eq!(ply(ascii_ply(&[faces, vertices])), plain);
    let edges = ["element edge 1\nproperty int vertex1\nproperty list uchar float weights\n", "3 2 0.5 1e-3\n"];
    assert_eq!(
        ply(ascii_ply(&[
            edges,
            faces,
            edges.map(|t| t.replace("edge 1", "other 1")).each_ref().map(String::as_str),
            vertices
        ])),
        plain
    );
    let strip = ["element tristrips 1\nproperty list int int vertex_indices\n", "3 0 2 1\n"];
    assert_eq!(ply(ascii_ply(&[strip, vertices])).triangles(), [[0, 2, 1]]);
}

/// Returns the tetrahedron in binary with faces first: 1 + 3 x 4 bytes per face. `word` gives the byte order of a word.
fn binary_faces_first(encoding: &str, word: fn(u32) -> [u8; 4]) -> Vec<u8> {
    let [[vertex, _], [face, _]] = ELEMENTS;
    let mut file = format!("ply\r\nformat {encoding} 1.0\r\ncomment Gr\u{f6}\r\n{face}{vertex}end_header\r\n")
        .replace("\r\n", "\n")
        .replace('\n', "\r\n")
        .into_bytes();
    for face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
        file.push(3);
        face.iter().for_each(|&corner| file.extend(word(corner)));
    }
    for place in [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        place.iter().for_each(|x| file.extend(word(x.to_bits())));
    }
    file
}

#[test]
fn line_ends_blank_lines_notations_of_numbers_and_types_of_indices_of_ply_change_nothing() {
    let text = ascii_ply(&ELEMENTS);
    let plain = ply(&text);
    for text in [
        text.replace("1 0 0\n", "1\n0 0\n"),
        text.replace("3 0 2 1\n", "3\n0 2\n\n1\n"),
        text.replace("1.0\n", "1.0\n\n"),
        text.replace('\n', "\n\n").replace("end_header\n\n", "end_header\n"),
        text.clone() + "\0\0\0\0",
        text.replace("vertex_indices", "indices"),
        text.replace("vertex_indices", "vertex_indexes").replace("3 0 2 1\n", "3 0 2 1 \n"),
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        format!("\u{feff}{text}"),
        text.replace(' ', "\t"),
    ] {
        assert_eq!(ply(&text), plain, "{text}");
    }
    for one in ["1.", "+1", "1e0", "1.0E+00", "10e-1", "0.1e1"] {
        assert_eq!(ply(text.replace("1 0 0\n", &format!("{one} 0 0\n"))), plain, "{one}");
    }
    assert_eq!(ply(text.replace("1 0 0\n", "1 .0 -.0\n")).triangles(), plain.triangles());
    for kinds in ["uint8 uint8", "char short", "int ushort", "uint uint", "uint16 int32"] {
        assert_eq!(ply(text.replace("uchar int", kinds)), plain, "{kinds}");
    }
}

#[test]
fn errors_name_the_line_of_the_file_and_bytes_that_are_not_text() {
    let message = |format, bytes: &[u8]| read(format, bytes).expect_err("damaged").to_string();
    for (text, expected) in [
        (&b"v 0 0 0\nv 1 \\\n two 0\nf 1 1 1\n"[..], "2: expected a number for y, found \"two\""),
        (b"v 0 0 0\nv \\\n0 0 1\nv 1 0 0\nf 1 2 \\\n9\n", "5: expected an index of one of 3 vertices, found 9"),
        (b"v 0 0 0\nv 0 \xe9 0\n", "2: expected a number for y, found \"\u{fffd}\""),
    ] {
        assert_eq!(message(Format::Obj, text), format!("test: line {expected}"));
    }
    let text = ascii_ply(&ELEMENTS);
    let faces_first = ascii_ply(&[ELEMENTS[1], ELEMENTS[0]]);
    for (text, expected) in [
        (text.replace("1 0 0\n", "1 0\n"), "line 11: expected a row of \"vertex\" (x y z), found \"1 0\""),
        (text.replace("1.0\n", "1.0\n\n").replace("1 0 0\n", "1 q 0\n"), "line 12: "),
        (faces_first.replace("3 1 2 3\n", "3 1 2 4\n"), "line 12: expected an index of one of 4 vertices, found 4"),
    ] {
        assert!(message(Format::Ply, text.as_bytes()).starts_with(&format!("test: {expected}")), "{text}");
    }
    assert!(message(Format::Ply, &[text.as_bytes(), &[0xff]].concat()).starts_with("test: line 18: "));
    let wide: Vec<u8> = "\u{feff}v 0 0 0\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let error = read(Format::Obj, wide).expect_err("UTF-16");
    assert_eq!((error.kind, &*error.found), (FileErrorKind::NotText, "byte 0xff"));
}

#[test]
fn in_binary_ply_files_faces_may_precede_the_vertices() {
    let plain = ply(ascii_ply(&ELEMENTS));
    assert_eq!(ply(binary_faces_first("binary_little_endian", u32::to_le_bytes)), plain);
    assert_eq!(ply(binary_faces_first("binary_big_endian", u32::to_be_bytes)), plain);
}

// Encodings and line ends.

#[test]
fn comments_and_names_in_any_encoding_are_accepted() {
    let latin = |text: &str| -> Vec<u8> { text.chars().map(|c| c as u8).collect() };
    let with_names =
        format!("# Gr\u{f6}\u{df}e\no W\u{fc}rfel\ng t\u{ea}te\nusemtl M\u{e9}tall\n{TETRAHEDRON}# \u{e9}\n");
    assert_eq!(obj(latin(&with_names)).triangles(), obj(TETRAHEDRON).triangles());
    for at in ["comment Gr\u{f6}\u{df}e\n", "obj_info d\u{e9}j\u{e0} vu\n", "comment \u{ff}\n"] {
        let text = ascii_ply(&ELEMENTS).replacen("element", &format!("{at}element"), 1);
        assert_eq!(ply(latin(&text)), ply(ascii_ply(&ELEMENTS)), "{at:?}");
    }
    let atom = "ATOM      1  N   SER A   1      11.000  -2.000   0.500  1.00  0.00           N  \n";
    let pdb = read(Format::Pdb, latin(&format!("REMARK Universit\u{e9}\n{atom}"))).expect("an atom");
    assert_eq!(pdb.spheres().len(), 1);
}

// Polygons with more than three corners.

/// Returns a polygon in the plane z = 0 as an OBJ file.
fn polygon_obj(points: &[(f64, f64)]) -> String {
    let vertices: String = points.iter().map(|(x, y)| format!("v {x} {y} 0\n")).collect();
    let face: String = (1..=points.len()).map(|n| format!(" {n}")).collect();
    format!("{vertices}f{face}\n")
}

/// Returns the area of a polygon by the shoelace formula.
fn shoelace(points: &[(f64, f64)]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| (a.0 * b.1 - b.0 * a.1) / 2.0).sum()
}

/// Checks that the triangles of a simple polygon cover it once. All have the polygon's orientation, and their areas add
/// up to its area.
fn assert_covers(points: &[(f64, f64)], scene: &Scene) {
    let whole = shoelace(points);
    let areas = areas(scene);
    let sum: f64 = areas.iter().map(|area| area.z).sum();
    // The scene stores positions in single precision.
    assert!((sum - whole).abs() < 1e-5 * whole.abs(), "{points:?}: {sum} for {whole}");
    assert!(areas.iter().all(|area| area.z * whole.signum() > -1e-6 * whole.abs()), "{points:?}: {areas:?}");
}

/// A concave polygon of four corners, with its notch at the third corner.
const DART: [(f64, f64); 4] = [(0.0, 2.0), (-2.0, -2.0), (0.0, -1.0), (2.0, -2.0)];

#[test]
fn the_notch_of_a_polygon_stays_open_for_any_start_and_orientation() {
    let polygons: [&[(f64, f64)]; 6] = [
        &DART,
        // The letters L and U, a star, a comb with points on straight lines, and a polygon with a repeated point.
        &[(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)],
        &[(0.0, 0.0), (3.0, 0.0), (3.0, 2.0), (2.0, 2.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)],
        &[(0.0, 3.0), (-0.5, 0.5), (-3.0, 0.0), (-0.5, -0.5), (0.0, -3.0), (0.5, -0.5), (3.0, 0.0), (0.5, 0.5)],
        &[
            (0.0, 0.0),
            (1.0, 0.0),
            (2.0, 0.0),
            (4.0, 0.0),
            (4.0, 2.0),
            (3.0, 2.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (0.0, 2.0),
            (0.0, 1.0),
        ],
        &[(0.0, 0.0), (0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)],
    ];
    for polygon in polygons {
        for begin in 0..polygon.len() {
            let mut turned = polygon.to_vec();
            turned.rotate_left(begin);
            assert_covers(&turned, &obj(polygon_obj(&turned)));
            turned.reverse();
            assert_covers(&turned, &obj(polygon_obj(&turned)));
        }
    }
}

#[test]
fn convex_polygons_stay_fans_even_with_corners_on_straight_lines() {
    let square = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
    assert_eq!(obj(polygon_obj(&square)).triangles(), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
    assert_covers(&square, &obj(polygon_obj(&square)));
}

#[test]
fn the_faces_of_ply_keep_their_notches_in_any_plane() {
    for (u, v) in
        [(DVec3::X, DVec3::Y), (DVec3::Y, DVec3::Z), (DVec3::Z, DVec3::X), (DVec3::new(0.6, 0.0, 0.8), DVec3::Y)]
    {
        let rows: String = DART
            .map(|(x, y)| x * u + y * v + DVec3::new(5.0, -3.0, 2.0))
            .map(|p| format!("{} {} {}\n", p.x, p.y, p.z))
            .concat();
        let scene = ply(format!(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nelement face 1\n\
             property list uchar int vertex_indices\nend_header\n{rows}4 1 2 3 0\n"
        ));
        let expected = u.cross(v) * shoelace(&DART);
        let areas = areas(&scene);
        let sum: DVec3 = areas.iter().sum();
        assert!((sum - expected).length() < 1e-5, "{sum} for {expected}");
        assert!(areas.iter().all(|area| area.dot(expected) > 0.0), "{areas:?}");
    }
}

#[test]
fn notches_of_any_size_stay_open() {
    for exponent in [-200, -40, 0, 14] {
        let scaled = DART.map(|(x, y)| (x * 10_f64.powi(exponent), y * 10_f64.powi(exponent)));
        let scene = from_bytes(polygon_obj(&scaled).as_bytes(), Format::Obj, "test").expect("a dart");
        let sum: f64 = areas(&scene).iter().map(|area| area.z).sum();
        let all: f64 = areas(&scene).iter().map(|area| area.z.abs()).sum();
        assert!(sum > 0.0 && (sum - all).abs() < 1e-6 * all, "1e{exponent}: {sum}, {all}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Generates polygons around the origin with a radius at each of several rising angles. The angles are less than
    /// half a turn apart, so a polygon never crosses itself.
    #[test]
    fn the_triangles_of_a_star_shaped_polygon_cover_each_of_its_points_once(
        radii in prop::collection::vec(0.1..4.0_f64, 4..200),
        begin in any::<prop::sample::Index>(),
        clockwise in any::<bool>(),
    ) {
        let step = std::f64::consts::TAU / radii.len() as f64;
        let at = |(n, radius): (usize, &f64)| (radius * (step * n as f64).cos(), radius * (step * n as f64).sin());
        let mut points: Vec<(f64, f64)> = radii.iter().enumerate().map(at).collect();
        points.rotate_left(begin.index(radii.len()));
        if clockwise {
            points.reverse();
        }
        assert_covers(&points, &obj(polygon_obj(&points)));
    }

    /// A polygon that crosses itself never makes the reader panic.
    #[test]
    fn polygons_that_cross_themselves_are_read(points in prop::collection::vec((-3..4_i32, -3..4_i32), 3..40)) {
        let points: Vec<(f64, f64)> = points.iter().map(|&(x, y)| (x.into(), y.into())).collect();
        match read(Format::Obj, polygon_obj(&points)) {
            Ok(scene) => prop_assert!(!scene.triangles().is_empty()),
            Err(error) => prop_assert!(error.to_string().contains("triangle with an area"), "{error}"),
        }
    }
}

// Shading by smoothing groups.

const CUBE: &str = "v -1 -1 -1\nv -1 -1 1\nv -1 1 -1\nv -1 1 1\nv 1 -1 -1\nv 1 -1 1\nv 1 1 -1\nv 1 1 1\n";
const FACES: [&str; 6] = ["f 1 2 4 3\n", "f 5 7 8 6\n", "f 1 5 6 2\n", "f 3 4 8 7\n", "f 1 3 7 5\n", "f 2 6 8 4\n"];

/// Returns true if every corner of a triangle has the triangle's own normal.
fn is_flat(scene: &Scene) -> bool {
    scene.triangles().iter().zip(areas(scene)).all(|(triangle, area)| {
        triangle.iter().all(|&corner| {
            let normal = scene.vertices()[corner as usize].normal.as_dvec3();
            (normal - area.normalize()).length() < 1e-6
        })
    })
}

#[test]
fn faces_of_obj_are_flat_if_smoothing_is_off() {
    let faces = FACES.concat();
    for off in ["", "s off\n", "s 0\n", "s Off\n", "s 1\ns off\n"] {
        let scene = obj(format!("{off}{CUBE}{faces}"));
        assert!(is_flat(&scene), "{off:?}");
        assert_eq!((scene.vertices().len(), scene.triangles().len()), (24, 12));
    }
    for on in ["s 1\n", "s on\n", "s 3\n", "s 4294967296\n"] {
        let scene = obj(format!("{on}{CUBE}{faces}"));
        assert_eq!(scene.vertices().len(), 8, "{on:?}");
        // At a corner of a cube the mean of three faces is the diagonal, unless a face has two triangles there. The
        // angle to each face is at most 45 degrees.
        let diagonal = |v: &pxpl5_scene::Vertex| v.position.normalize().dot(v.normal);
        assert!(scene.vertices().iter().all(|v| diagonal(v) > 0.9), "{on:?}");
    }
}

#[test]
fn smoothing_groups_are_shaded_separately() {
    let grouped: String = (1..).zip(FACES).map(|(group, face)| format!("s {group}\n{face}")).collect();
    assert!(is_flat(&obj(format!("{CUBE}{grouped}"))));
    // Two faces of one group meet at a right angle. At their common edge the normal is the mean, elsewhere each face
    // has its own normal.
    let scene = obj(format!("{CUBE}s 1\n{}{}s off\n{}", FACES[0], FACES[2], FACES[1]));
    let mean = |v: &&pxpl5_scene::Vertex| (v.normal - Vec3::new(-1.0, -1.0, 0.0).normalize()).length() < 0.4;
    assert_eq!(scene.vertices().iter().filter(mean).count(), 2);
}

#[test]
fn normals_of_the_file_win_over_smoothing_off() {
    let scene = obj(format!("s off\n{CUBE}vn 0.6 0.8 0\nf 1//1 2//1 4//1 3//1\n"));
    assert!(scene.vertices().iter().all(|v| v.normal == Vec3::new(0.6, 0.8, 0.0)));
}

#[test]
fn a_flat_shaded_face_that_is_not_planar_has_one_normal() {
    let scene = obj("v 0 0 0\nv 1 0 0\nv 1 1 0.2\nv 0 1 0\nf 1 2 3 4\n");
    assert_eq!(scene.vertices().len(), 4);
    assert!(scene.vertices().iter().all(|v| v.normal == scene.vertices()[0].normal));
}

// Colours of vertices and faces.

#[test]
fn colours_of_obj_vertices_may_be_fractions_or_bytes() {
    let with = |colours: [&str; 4]| {
        let points = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"];
        let vertices: String = points.iter().zip(colours).map(|(p, c)| format!("v {p} {c}\n")).collect();
        obj(format!("{vertices}s 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"))
    };
    // The colours are in the order in which the faces name the points: 1, 3, 2, 4.
    let of = |scene: &Scene| scene.vertices().iter().map(|v| v.colour).collect::<Vec<_>>();
    let expected = [[255, 0, 0], [0, 0, 255], [0, 128, 0], [255, 255, 255]];
    assert_eq!(of(&with(["1 0 0", "0 0.5 0", "0 0 1.0", "1 1 1"])), expected);
    assert_eq!(of(&with(["255 0 0", "0 128 0", "0 0 255", "255 255 255"])), expected);
    assert_eq!(of(&with(["1.0 0 0 1", "0 5e-1 0 1", "0 0 1 1", "1 1 1 1"])), expected);
    // One component above 1 does not make bytes of fractions.
    let orange = "1.02 0.5 0";
    assert_eq!(of(&with([orange; 4])), [[255, 128, 0]; 4]);
    assert_eq!(of(&with(["255.0 0 0", "0 128.0 0", "0 0 255.0", "255 255 255"])), expected);
    // A fourth number alone is a weight and not a colour. A point without a colour is grey, even if other points have
    // colours.
    assert!(of(&with(["1", "1", "1.0", "0.5"])).iter().all(|colour| *colour == DEFAULT_COLOUR));
    assert_eq!(of(&with(["1 0 0", "", "", ""]))[..2], [[255, 0, 0], DEFAULT_COLOUR]);
    let error = read(Format::Obj, "v 0 0 0 red 0 0\n").expect_err("no number").to_string();
    assert_eq!(error, "test: line 1: expected a number for red, found \"red\"");
}

#[test]
fn unread_materials_cause_one_warning() {
    let scene = obj(format!("usemtl a\nusemtl b\n{TETRAHEDRON}"));
    assert_eq!(scene.warnings(), ["colours of materials (usemtl) are not read: faces have one colour"]);
    assert!(obj(TETRAHEDRON).warnings().is_empty());
}

fn coloured_faces(names: [&str; 3], kind: &str, rows: [&str; 4]) -> String {
    let properties: String = names.map(|name| format!("property {kind} {name}\n")).concat();
    let faces = ["3 0 2 1", "3 0 1 3", "3 1 2 3", "3 2 0 3"];
    let faces: String = faces.iter().zip(rows).map(|(face, colour)| format!("{face} {colour}\n")).collect();
    let header = format!("{}{properties}", ELEMENTS[1][0]);
    ascii_ply(&[ELEMENTS[0], [&header, &faces]])
}

#[test]
fn colours_of_ply_faces_are_drawn_and_do_not_change_the_shading() {
    let bytes = ["255 0 0", "0 255 0", "0 0 255", "255 0 0"];
    let plain = ply(ascii_ply(&ELEMENTS));
    for (names, kind, rows) in [
        (["red", "green", "blue"], "uchar", bytes),
        (["diffuse_red", "diffuse_green", "diffuse_blue"], "uint8", bytes),
        (["r", "g", "b"], "int", bytes),
        (["red", "green", "blue"], "float", ["1 0 0", "0 1 0", "0 0 1", "1.0 0 0"]),
    ] {
        let scene = ply(coloured_faces(names, kind, rows));
        for (triangle, expected) in scene.triangles().iter().zip([[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 0, 0]]) {
            for &corner in triangle {
                let vertex = scene.vertices()[corner as usize];
                assert_eq!(vertex.colour, expected);
                let same = plain.vertices().iter().find(|v| v.position == vertex.position).expect("a point");
                assert_eq!(vertex.normal, same.normal);
            }
        }
        assert_eq!(scene.triangles().len(), 4);
    }
}

// Normals that are NaN.

#[test]
fn invalid_normals_are_recomputed_with_one_warning() {
    let smooth = TETRAHEDRON.replacen('f', "s 1\nf", 1);
    let plain = obj(&smooth);
    for nan in ["nan", "NaN", "-nan", "-nan(ind)", "nan(0x8000)", "1.#QNAN", "inf", "-inf", "1.#INF"] {
        let text = smooth.replace("s 1", &format!("vn 0 0 1\nvn {nan} {nan} 0\ns 1"));
        let text = text.replace("f 1 3 2", "f 1//2 3//2 2//2").replace("f 3 1 4", "f 3//2 1//2 4//2");
        let scene = obj(text);
        assert_eq!(scene.vertices(), plain.vertices(), "{nan}");
        assert_eq!(scene.warnings(), ["1 normal without numbers, first in line 6: computed from the faces instead"]);
        let header = format!("{}property float nx\nproperty float ny\nproperty float nz\n", ELEMENTS[0][0]);
        let rows = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"].map(|row| format!("{row} {nan} {nan} {nan}\n")).concat();
        let scene = ply(ascii_ply(&[[&header, &rows], ELEMENTS[1]]));
        assert_eq!(scene.vertices(), ply(ascii_ply(&ELEMENTS)).vertices(), "{nan}");
        assert_eq!(scene.warnings(), ["4 normals without numbers, first in line 13: computed from the faces instead"]);
    }
}

#[test]
fn an_invalid_coordinate_is_refused_with_its_place() {
    for nan in ["nan", "-nan(ind)", "1.#IND"] {
        let error = read(Format::Obj, format!("v 0 {nan} 0\n")).expect_err("no place").to_string();
        assert!(error.starts_with("test: line 1: expected a coordinate") && error.ends_with("found NaN"), "{error}");
        let error = read(Format::Ply, ascii_ply(&ELEMENTS).replace("0 1 0", &format!("0 {nan} 0")));
        let error = error.expect_err("no place").to_string();
        assert!(error.starts_with("test: line 12: expected a coordinate") && error.ends_with("found NaN"), "{error}");
    }
}

// Atoms of PDB files.

/// Returns a line of a PDB file without element columns. `name` fills columns 13 to 16.
fn atom(record: &str, name: &str, residue: &str) -> String {
    assert_eq!(name.len(), 4);
    format!("{record:<6}    1 {name} {residue:>3} A   1    {:>8.3}{:>8.3}{:>8.3}  1.00  0.00\n", 1.0, 2.0, 3.0)
}

/// Returns the radius of an atom relative to carbon, and its colour.
fn drawn(line: &str) -> (f32, [u8; 3]) {
    let carbon = format!("{:<76} C\n", atom("ATOM", " C  ", "GLY").trim_end());
    let scene = read(Format::Pdb, format!("{carbon}{line}")).expect("two atoms");
    let [carbon, atom] = scene.spheres() else { panic!("two spheres") };
    (atom.radius / carbon.radius * 1.70, atom.colour)
}

#[test]
fn missing_element_columns_are_replaced_by_the_names_of_atoms() {
    // Names of atoms with their residues, where an underscore is a blank.
    for (record, radius, names) in [
        (
            "ATOM",
            1.20,
            "HG11 VAL, HD21 LEU, 1HG1 VAL, _HB2 VAL, HE21 GLN, HH11 ARG, HO5' DA, H5'' DA, _D__ SER, DG11 VAL",
        ),
        ("HETATM", 1.20, "HN1_ LIG, H101 LIG"),
        ("ATOM", 1.70, "_CA_ VAL, CA__ VAL, _CD1 LEU, CD1_ LEU"),
        ("HETATM", 1.70, "_CA_ LIG, C10A LIG, CA1B LIG"),
        ("ATOM", 1.55, "_NE2 GLN"),
        ("HETATM", 1.55, "_NA_ HEM"),
        ("ATOM", 1.52, "_OE1 GLU, _O__ HOH, _OXT GLY"),
        ("ATOM", 1.80, "_SD_ MET, _P__ DA"),
        ("HETATM", 1.75, "CL__ CL, CL1_ LIG, CL12 LIG"),
        ("HETATM", 1.90, "SE__ MSE"),
        ("HETATM", 2.00, "FE__ HEM, CA__ CA, MN__ MN"),
        ("ATOM", 2.00, "CA__ CA"),
        ("HETATM", 1.85, "BR1_ LIG"),
        ("HETATM", 2.27, "NA__ NA"),
        ("HETATM", 1.39, "ZN__ ZN"),
        ("HETATM", 1.73, "MG__ MG"),
        ("HETATM", 2.75, "_K__ K"),
        ("HETATM", 1.98, "_I1_ LIG"),
        // Ions, as simulation programs name them.
        ("ATOM", 2.27, "SOD_ SOD, _NA_ SOD, NA+_ NA+, Na+_ Na+"),
        ("ATOM", 2.75, "POT_ POT, K+__ K+"),
        ("ATOM", 1.75, "CLA_ CLA, Cl-_ Cl-"),
        ("ATOM", 2.00, "CAL_ CAL"),
        ("HETATM", 1.70, "_CAL LIG"),
        ("ATOM", 1.82, "LIT_ LIT"),
        ("ATOM", 3.03, "RUB_ RUB"),
        ("ATOM", 3.43, "CES_ CES"),
        ("ATOM", 1.39, "ZN2_ ZN2"),
        // Chlorophyll has the name of an ion.
        ("HETATM", 1.73, "MG__ CLA"),
        ("HETATM", 1.55, "_NA_ CLA"),
        // Names of residues in force fields, with names of atoms from column 13 on.
        ("ATOM", 1.70, "CA__ HSD, CE__ LYN, CE__ MSE"),
        ("ATOM", 1.55, "NE2_ HIP"),
        ("ATOM", 1.52, "OD2_ ASH"),
        // Copper and mercury are not in the table, so they are drawn as all other elements.
        ("HETATM", 1.80, "CU__ CU, HG__ HG"),
    ] {
        for (name, residue) in names.split(", ").filter_map(|both| both.split_once(' ')) {
            let found = drawn(&atom(record, &name.replace('_', " "), residue)).0;
            assert!((found - radius).abs() < 1e-4, "{record} {name:?} {residue}: {found} for {radius}");
        }
    }
    assert_eq!(drawn(&atom("HETATM", "CU  ", "CU")).1, [255, 20, 147], "copper is no sulphur");
}

/// A file with the name `N` in column 13 begins all names there, so `CD` and `NA` of an unknown residue are no metals.
#[test]
fn names_that_all_begin_in_column_13_do_not_tell_the_length_of_the_symbol() {
    for (name, radius) in [("CA  ", 1.70), ("CD  ", 1.70), ("NE  ", 1.55), ("CL  ", 1.75), ("ZN  ", 1.39)] {
        let file = atom("ATOM", "N   ", "UNK") + &atom("ATOM", name, "UNK");
        let scene = read(Format::Pdb, file).expect("two atoms");
        let [nitrogen, atom] = scene.spheres() else { panic!("two spheres") };
        assert!((atom.radius / nitrogen.radius * 1.55 - radius).abs() < 1e-4, "{name}");
    }
}

#[test]
fn a_second_model_or_an_end_ends_the_first_model() {
    let one = atom("ATOM", " CA ", "VAL");
    for between in ["MODEL        2\n", "END\n", "ENDMDL\nMODEL        2\n", "ENDMDL\n"] {
        let scene = read(Format::Pdb, format!("MODEL        1\n{one}{between}{one}END\n")).expect("a model");
        assert_eq!(scene.spheres().len(), 1, "{between:?}");
    }
}

#[test]
fn unknown_text_in_the_element_columns_is_ignored() {
    // Old files number their lines in columns 73 to 80.
    for end in ["1CRN  70", "1CRN 123", "        ", ""] {
        let line = format!("{:<72}{end}\n", atom("ATOM", " CA ", "VAL").trim_end());
        assert!((drawn(&line).0 - 1.70).abs() < 1e-4, "{end:?}");
    }
    for (symbol, radius) in [("FE", 2.00), ("Fe", 2.00), (" C", 1.70), ("C ", 1.70), ("CA", 2.00), ("CL", 1.75)] {
        let line = format!("{:<76}{symbol}\n", atom("ATOM", " CA ", "VAL").trim_end());
        assert!((drawn(&line).0 - radius).abs() < 1e-4, "{symbol}");
    }
}

// Models without visible content.

#[test]
fn a_model_without_a_triangle_that_has_an_area_is_refused() {
    for text in [
        "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n",
        "v 3 4 5\nf 1 1 1\n",
        "v 0 0 0\nv 1 2 3\nv 2 4 6\nf 1 2 3\n",
        "v 0.1 0.1 0.1\nv 0.3 0.3 0.3\nv 0.7 0.7 0.7\nv 0.9 0.9 0.9\nf 1 2 3 4\n",
        "v 0 0 0\nv 1e-300 0 0\nv 2e-300 0 0\nf 1 2 3\n",
    ] {
        let error = read(Format::Obj, text).expect_err(text).to_string();
        assert_eq!(error, "test: expected at least one triangle with an area, found none");
    }
    let line = ascii_ply(&ELEMENTS).replace("0 1 0\n0 0 1\n", "2 0 0\n3 0 0\n");
    assert!(read(Format::Ply, line).expect_err("a line").to_string().contains("triangle with an area"));
    // One triangle with an area is enough, however small and thin.
    let thin = obj("v 0 0 0\nv 1 0 0\nv 0 1e-9 0\nv 2 0 0\nf 1 2 4\nf 1 2 3\n");
    assert_eq!(thin.triangles().len(), 2);
    let fitted = from_bytes(b"v 0 0 0\nv 1e-300 0 0\nv 0 1e-300 0\nf 1 2 3\n", Format::Obj, "test").expect("small");
    assert!((f64::from(fitted.bounding_sphere().1) - IMPORT_RADIUS_M).abs() < 1e-6);
}
