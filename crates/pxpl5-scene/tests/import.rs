//! Importers with files written by hand: results, and errors for invalid files.

use glam::Vec3;
use pxpl5_scene::config::{DEFAULT_COLOUR, IMPORT_RADIUS_M};
#[cfg(feature = "files")]
use pxpl5_scene::load;
use pxpl5_scene::{Format, Scene, from_bytes};
use pxpl5_sim::parameters::{FileError, FileErrorKind};

fn read(format: Format, text: impl AsRef<[u8]>) -> Result<Scene, FileError> {
    from_bytes(text.as_ref(), format, "test")
}

fn obj(text: &str) -> Scene {
    read(Format::Obj, text).unwrap_or_else(|error| panic!("{error}"))
}

fn ply(text: impl AsRef<[u8]>) -> Scene {
    read(Format::Ply, text).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the corners of the square (+-1, +-1, 0) after import: the centre is the origin, and the corners lie at the
/// radius of imported models.
fn fitted_square() -> [Vec3; 4] {
    let half = IMPORT_RADIUS_M as f32 / 2.0_f32.sqrt();
    [(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, y)| Vec3::new(x, y, 0.0))
}

fn assert_square(scene: &Scene) {
    assert_eq!(scene.triangles(), [[0, 1, 2], [0, 2, 3]]);
    for (vertex, expected) in scene.vertices().iter().zip(fitted_square()) {
        assert!((vertex.position - expected).length() < 1e-6, "{}", vertex.position);
        assert!((vertex.normal - Vec3::Z).length() < 1e-6);
    }
}

const SQUARE_OBJ: &str = "# a square, 5 right and 2 wide\no s\nv 4 -1 0\nv 6 -1 0\nv 6 1 0\nv 4 1 0\ng x\nusemtl m\n";

#[test]
fn quads_are_cut_into_fans_with_indices_in_every_notation_and_fitted_to_the_view() {
    for faces in [
        "f 1 2 3 4\n",
        // Negative indices count back from the last vertex so far.
        "f -4 -3 -2 -1\nv 4.5 0 0\n",
        // Texture coordinates are ignored.
        "vt 0 0\nvn 0 0 2\nf 1/1 2/1/1 3//1 4\n",
        "vt 0 0\nf 1/1/ 2/1 3// 4 # comment\r\n",
    ] {
        assert_square(&obj(&format!("{SQUARE_OBJ}{faces}")));
    }
}

#[test]
fn normals_in_the_file_replace_computed_normals_and_a_vertex_with_two_normals_is_split() {
    let scene = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 1 0 0\nvn 0 3 0\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n");
    assert_eq!(scene.vertices().len(), 6);
    assert_eq!(scene.vertices()[0].normal, Vec3::X);
    assert_eq!(scene.vertices()[3].normal, Vec3::Y);
    assert_eq!(scene.vertices()[0].position, scene.vertices()[3].position);
}

#[test]
fn missing_normals_are_the_mean_of_the_triangles_weighted_by_area() {
    // Two triangles share a corner: one of area 1/2 faces +z, and one of area 1 faces +x. The mean normal is (2, 0, 1)
    // / sqrt 5.
    let scene = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 2 0\nv 0 0 1\ns 1\nf 1 2 3\nf 1 4 5\n");
    let expected = Vec3::new(2.0, 0.0, 1.0) / 5.0_f32.sqrt();
    assert!((scene.vertices()[0].normal - expected).length() < 1e-6);
    assert_eq!(scene.vertices()[0].colour, DEFAULT_COLOUR);
}

#[test]
fn models_of_any_size_are_scaled_to_the_import_radius() {
    for size in ["1e-300", "1e-40", "1e15"] {
        let scene = obj(&format!("v 0 0 0\nv {size} 0 0\nv 0 {size} 0\nf 1 2 3\n"));
        let (_, radius) = scene.bounding_sphere();
        assert!((f64::from(radius) - IMPORT_RADIUS_M).abs() < 1e-6, "{size}: {radius}");
        assert_eq!(scene.vertices()[0].normal, Vec3::Z, "{size}");
    }
}

#[test]
fn unused_points_are_dropped_at_any_distance() {
    let scene = ply("ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double y\n\
        property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
        1e15 0 0\n0 0 0\n-1e15 0 0\n1e-300 0 0\n0 1e-300 0\n3 1 3 4\n");
    assert_eq!((scene.vertices().len(), scene.triangles()), (3, &[[0, 1, 2]][..]));
    assert!((f64::from(scene.bounding_sphere().1) - IMPORT_RADIUS_M).abs() < 1e-6);
}

const SQUARE_HEADER: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
    property uchar red\nproperty uchar green\nproperty uchar blue\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n";

/// Returns the square as a binary PLY file. `word` returns the 4 bytes of a number in the byte order of the file.
fn binary_square(encoding: &str, word: fn(u32) -> [u8; 4]) -> Vec<u8> {
    let mut file = format!("ply\nformat {encoding} 1.0\n{SQUARE_HEADER}").into_bytes();
    for (x, y) in [(4.0_f32, -1.0_f32), (6.0, -1.0), (6.0, 1.0), (4.0, 1.0)] {
        for value in [x, y, 0.0] {
            file.extend(word(value.to_bits()));
        }
        file.extend([10, 20, 30]);
    }
    file.push(4);
    (0..4).for_each(|corner| file.extend(word(corner)));
    file
}

fn ascii_square() -> String {
    let rows = "4e0 -1 0 10 20 30\n6 -10e-1 +0.0 10 20 30\n6 1 0 10 20 30\n4 1 0 10 20 30\n4 0 1 2 3\n";
    format!("ply\nformat ascii 1.0\ncomment by hand\n{SQUARE_HEADER}{rows}")
}

#[test]
fn the_three_encodings_of_ply_give_the_same_scene() {
    let ascii = ply(ascii_square());
    assert_square(&ascii);
    assert_eq!(ascii.vertices()[2].colour, [10, 20, 30]);
    assert_eq!(ply(binary_square("binary_little_endian", u32::to_le_bytes)), ascii);
    assert_eq!(ply(binary_square("binary_big_endian", u32::to_be_bytes)), ascii);
}

#[test]
fn normals_doubles_fractional_colours_and_unknown_elements_of_ply_are_read() {
    let scene = ply("ply\nformat ascii 1.0\nelement junk 2\nproperty int a\nelement vertex 3\nproperty double x\n\
        property double y\nproperty double z\nproperty float nx\nproperty float ny\nproperty float nz\n\
        property float red\nproperty float green\nproperty float blue\nproperty float quality\n\
        element face 1\nproperty list uchar uint vertex_index\nend_header\n\
        1\n2\n0 0 0 0 2 0 1 0.5 0 9\n1 0 0 0 2 0 1 0.5 0 9\n0 1 0 0 2 0 1 0.5 0 9\n3 0 1 2\n");
    assert_eq!((scene.vertices()[1].normal, scene.vertices()[1].colour), (Vec3::Y, [255, 128, 0]));
}

/// Returns a scene as an ASCII PLY file that has all digits of every number.
fn written(scene: &Scene) -> String {
    let vertices = scene.vertices();
    let triangles = scene.triangles();
    let mut text = format!("ply\nformat ascii 1.0\nelement vertex {}\n", vertices.len());
    for name in ["x", "y", "z", "nx", "ny", "nz"] {
        text += &format!("property float {name}\n");
    }
    for name in ["red", "green", "blue"] {
        text += &format!("property uchar {name}\n");
    }
    text += &format!("element face {}\nproperty list uchar int vertex_indices\nend_header\n", triangles.len());
    for v in vertices {
        let [x, y, z] = v.position.to_array();
        let [a, b, c] = v.normal.to_array();
        let [red, green, blue] = v.colour;
        text += &format!("{x} {y} {z} {a} {b} {c} {red} {green} {blue}\n");
    }
    triangles.iter().for_each(|[a, b, c]| text += &format!("3 {a} {b} {c}\n"));
    text
}

#[test]
fn a_scene_written_as_ply_is_read_back() {
    let mig = pxpl5_scene::builtin("mig").expect("a built-in scene");
    let back = ply(written(&mig));
    let again = ply(written(&back));
    assert_eq!(back.triangles(), mig.triangles());
    // The first import scales the radius of 2 m to the radius of imported models and keeps the centre. The second
    // import changes nothing except for rounding.
    let scale = (IMPORT_RADIUS_M / 2.0) as f32;
    for ((a, b), c) in mig.vertices().iter().zip(back.vertices()).zip(again.vertices()) {
        assert!((a.position * scale - b.position).length() < 1e-6);
        assert!((b.position - c.position).length() < 1e-6);
        assert!((a.normal - b.normal).length() < 1e-6);
        assert_eq!(a.colour, b.colour);
    }
}

const SERINE: &str = "\
HEADER    TEST\n\
ATOM      1  N   SER A   1      11.000  -2.000   0.500  1.00  0.00           N  \n\
ATOM      2  CA ASER A   1      13.000  -2.000   0.500  1.00  0.00           C  \n\
ATOM      3  CA BSER A   1      14.000  -2.000   0.500  1.00  0.00           C  \n\
HETATM    4 FE   HEM A   2      12.000   1.000   0.500  1.00  0.00          FE  \n\
HETATM    5  O   HOH A   3      12.000  -1.000   0.500\n\
ENDMDL\n\
ATOM      6  N   SER A   1      99.000  -2.000   0.500  1.00  0.00           N  \n";

#[test]
fn atoms_become_spheres_with_van_der_waals_radii_and_their_colours() {
    let scene = read(Format::Pdb, SERINE).expect("sound");
    // The scene has N, the first location of C, Fe and O, but neither the second location nor the second model. The
    // radii are from Bondi 1964.
    let radii: Vec<f32> = scene.spheres().iter().map(|s| s.radius / scene.spheres()[0].radius).collect();
    for (radius, expected) in radii.iter().zip([1.55, 1.70, 2.00, 1.52]) {
        assert!((radius - expected / 1.55).abs() < 1e-6);
    }
    assert_eq!(radii.len(), 4);
    assert_eq!(scene.spheres()[3].colour, [240, 24, 24]);
    // The atoms are 2 Ångström apart along x, on the scale in which the nitrogen has a radius of 1.55.
    let apart = scene.spheres()[1].centre - scene.spheres()[0].centre;
    assert!((apart.x / scene.spheres()[0].radius - 2.0 / 1.55).abs() < 1e-5);
}

#[test]
fn an_empty_file_and_a_file_with_nothing_to_draw_are_refused_in_every_format() {
    let empty = |format, text: &str| {
        let error = read(format, text).expect_err("nothing to draw");
        assert_eq!(error.kind, FileErrorKind::Empty, "{text:?}");
        error.expected.into_string()
    };
    let ply =
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    for (format, text, missing) in
        [(Format::Ply, ply, "triangle"), (Format::Obj, "v 0 0 0\n", "triangle"), (Format::Pdb, "HEADER\n", "atom")]
    {
        ["", " \r\n\n"].iter().for_each(|text| drop(empty(format, text)));
        assert_eq!(empty(format, text), format!("at least one {missing}"));
    }
}

#[test]
fn a_coordinate_that_is_not_finite_is_refused() {
    for bad in ["nan", "inf", "-inf", "1e16", "-1e300", "1e999"] {
        let error = read(Format::Obj, format!("v 0 0 0\nv 0 {bad} 0\nf 1 2 1\n")).expect_err(bad);
        assert_eq!((error.kind, &*error.place), (FileErrorKind::Number, "line 2"), "{bad}");
    }
    let mut file = binary_square("binary_little_endian", u32::to_le_bytes);
    let second_vertex = file.len() - 17 - 3 * 15;
    file[second_vertex..second_vertex + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    let error = read(Format::Ply, file).expect_err("no place");
    let place = format!("byte {second_vertex}");
    assert_eq!((error.kind, &*error.place, &*error.found), (FileErrorKind::Number, &*place, "NaN"));
}

#[test]
fn an_index_of_ply_out_of_range_is_named_with_its_place() {
    let ascii = ascii_square().replace("4 0 1 2 3", "4 0 1 2 -3");
    let error = read(Format::Ply, ascii).expect_err("a negative index").to_string();
    assert_eq!(error, "test: line 18: expected an index of one of 4 vertices, found -3");
    let mut file = binary_square("binary_big_endian", u32::to_be_bytes);
    let face = file.len() - 17;
    file[face + 4] = 4;
    let error = read(Format::Ply, file).expect_err("an index of 4");
    let place = format!("byte {face}");
    assert_eq!((error.kind, &*error.place, &*error.found), (FileErrorKind::Index, &*place, "4"));
}

#[test]
fn a_truncated_ply_file_is_refused() {
    for file in
        [binary_square("binary_little_endian", u32::to_le_bytes), binary_square("binary_big_endian", u32::to_be_bytes)]
    {
        for length in 0..file.len() {
            assert!(read(Format::Ply, &file[..length]).is_err(), "{length} bytes");
        }
        let last = read(Format::Ply, &file[..file.len() - 1]);
        assert!(matches!(last, Err(ref error) if error.kind == FileErrorKind::Truncated), "{last:?}");
    }
    let text = ascii_square();
    let last_row = text.len() - "4 0 1 2 3\n".len();
    let cut = read(Format::Ply, &text[..last_row]);
    assert!(matches!(cut, Err(ref error) if error.kind == FileErrorKind::Truncated), "{cut:?}");
}

#[test]
fn an_absurd_count_in_a_header_is_refused_at_once() {
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for count in ["4000000000", "18446744073709551615"] {
            let header = SQUARE_HEADER.replace("vertex 4", &format!("vertex {count}"));
            let file = format!("ply\nformat {encoding} 1.0\n{header}0 0 0 0 0 0\n");
            let answer = read(Format::Ply, file);
            assert!(matches!(answer, Err(ref error) if error.kind == FileErrorKind::Truncated), "{answer:?}");
        }
    }
    let endless = "ply\nformat binary_little_endian 1.0\nelement nothing 4000000000\nend_header\n";
    assert!(matches!(read(Format::Ply, endless), Err(ref error) if error.kind == FileErrorKind::Truncated));
}

#[test]
fn an_absurd_count_of_corners_is_refused_at_once() {
    let mut file =
        b"ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uint int vertex_indices\nend_header\n"
            .to_vec();
    file.extend(4_000_000_000_u32.to_le_bytes());
    let answer = read(Format::Ply, file);
    assert!(matches!(answer, Err(ref error) if error.kind == FileErrorKind::Truncated), "{answer:?}");
}

#[test]
fn format_errors_name_line_expected_and_found() {
    // Eight lines come before a face of the square, and thirteen lines of header before the rows.
    let face = |corners: &str| format!("{SQUARE_OBJ}f {corners}\n");
    let row = ascii_square().replace("6 1 0", "6 one 0");
    let list = ascii_square().replace("property float y\n", "property list uchar float y\n");
    let list = list.replace("4e0 -1 0", "4 1 -1 0");
    for (format, text, expected) in [
        (Format::Obj, "v 1 two 3\n", "1: expected a number for y, found \"two\""),
        (Format::Obj, "v 1 2\n", "1: expected a number for z, found \"\""),
        (Format::Obj, "v 1 2 3\nf 1 x 1\n", "2: expected an index of vertices, found \"x\""),
        (Format::Obj, "v 1 2 3\nf 1 1\n", "2: expected a face of at least 3 corners, found 2 in \"f 1 1\""),
        (Format::Obj, &face("1 2 5"), "9: expected an index of one of 4 vertices, found 5"),
        (Format::Obj, &face("1 2 0"), "9: expected an index of one of 4 vertices, found 0"),
        (Format::Obj, &face("1 2 -5"), "9: expected an index of one of 4 vertices, found -5"),
        (Format::Obj, &face("1 2 99999999999"), "9: expected an index of one of 4 vertices, found 99999999999"),
        (Format::Obj, &face(&format!("1 2 {}", i64::MIN)), "9: expected an index of one of 4 vertices, found -922"),
        (Format::Obj, &face("1//1 2//1 3//1"), "9: expected an index of one of 0 normals, found 1"),
        (
            Format::Pdb,
            "ATOM      1  N   SER A   1      11.0x0\n",
            "1: expected a number for x in columns 31 to 38, found \"11.0x0\"",
        ),
        (Format::Ply, "plx\n", "1: expected a line of a PLY header, found \"plx\""),
        (
            Format::Ply,
            "ply\nformat ascii 1.0\nelement vertex many\nend_header\n",
            "3: expected a line of a PLY header, found \"element vertex many\"",
        ),
        (Format::Ply, &row, "16: expected a row of \"vertex\" (x y z red green blue), found \"6 one 0 10 20 30\""),
        (Format::Ply, &list, "14: "),
    ] {
        let error = read(format, text).expect_err(text).to_string();
        assert!(error.starts_with(&format!("test: line {expected}")), "{text}: {error}");
    }
    assert!(read(Format::Ply, list).expect_err("a list").to_string().contains("List(UChar, Float)"));
}

#[cfg(feature = "files")]
#[test]
fn paths_that_lead_to_no_model_are_refused() {
    let folder = std::env::temp_dir().join(format!("pxpl5-scene-{}", std::process::id()));
    let directory = folder.join("directory.ply");
    std::fs::create_dir_all(&directory).expect("a temporary directory");
    assert!(matches!(load(&directory), Err(ref error) if error.kind == FileErrorKind::NotAFile));
    assert!(matches!(load(&folder), Err(ref error) if error.kind == FileErrorKind::NotAFile));
    assert!(matches!(load(folder.join("missing.obj")), Err(ref error) if error.kind == FileErrorKind::Unreadable));
    let strange = folder.join("model.3ds");
    std::fs::write(&strange, "solid").expect("a temporary file");
    let error = load(&strange).expect_err("no importer");
    assert_eq!((error.kind, &*error.found), (FileErrorKind::UnknownFormat, "\"3ds\""));
    let good = folder.join("SQUARE.OBJ");
    std::fs::write(&good, format!("{SQUARE_OBJ}f 1 2 3 4\n")).expect("a temporary file");
    assert_square(&load(&good).expect("a square"));
    let error = load(folder.join("missing.obj")).expect_err("missing").to_string();
    assert!(error.contains("missing.obj: expected a readable file, found:"), "{error}");
    std::fs::remove_dir_all(&folder).expect("its own directory");
}

#[test]
fn a_byte_order_mark_and_lines_that_end_in_cr_change_nothing() {
    let text = format!("{SQUARE_OBJ}f 1 2 3 4\n");
    let first_is_a_vertex = text.trim_start_matches("# a square, 5 right and 2 wide\no s\n");
    assert_square(&obj(&format!("\u{feff}{first_is_a_vertex}")));
    assert_square(&obj(&text.replace('\n', "\r\n")));
    assert_square(&obj(&text.replace('\n', "\r")));
    let error = read(Format::Obj, "v 0 0 0\rv 1 0 x\r").expect_err("no number").to_string();
    assert!(error.contains("line 2"), "{error}");
}

/// Superfluous content is refused at every position of a PLY file: repeated elements, numbers after a row, and rows
/// after the last.
#[test]
fn surplus_data_in_a_ply_file_is_refused_with_its_place() {
    let file = |version: &str, again: &str, vertex: &str, face: &str, rest: &str| {
        format!(
            "ply\nformat ascii {version}\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{again}element face 1\n\
             property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0{vertex}\n0 1 0\n3 0 1 2{face}\n{rest}"
        )
    };
    ply(file("1.0", "", "", "", "\n \n"));
    for (text, says) in [
        (file("2.0", "", "", "", ""), "line 2: expected version 1.0, found \"2.0\""),
        (
            file("1.0", "property float y\n", "", "", ""),
            "line 7: expected a property that the element does not have yet",
        ),
        (file("1.0", "", " 7", "", ""), "line 11: expected the end of a row of \"vertex\" (x y z), found \"7\""),
        (file("1.0", "", "", " 0", ""), "line 13: expected the end of a row of \"face\" (vertex_indices), found \"0\""),
        (file("1.0", "", "", "", "3 0 1 2\n"), "line 14: expected the end of the file after the last row"),
    ] {
        let error = read(Format::Ply, &text).expect_err(says).to_string();
        assert!(error.contains(says), "{error}");
    }
}

#[test]
fn triangle_strips_are_read_and_every_other_triangle_is_reversed() {
    let scene = ply(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n\
                     property list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 1 2\n",
    );
    assert_eq!(scene.triangles(), [[0, 1, 2], [2, 1, 3], [0, 1, 2]]);
    // All triangles face the viewer.
    assert!(scene.vertices().iter().all(|vertex| vertex.normal == Vec3::Z));
}

/// Serine 5 has two locations of CB and one of OG, and a third residue shares its position. Atom CA of residue 6 has
/// only the locations B and C.
#[test]
fn an_atom_has_its_first_alternate_location() {
    let atom = |name: &str, alternate: &str, residue: &str, place: u32, x: f64| {
        format!("ATOM      1  {name:<3}{alternate}{residue} A{place:>4}    {x:>8.3}{:>8.3}{:>8.3}\n", 0.0, 0.0)
    };
    let text = [
        atom("N", " ", "SER", 5, 1.0),
        atom("CB", "A", "SER", 5, 2.0),
        atom("CB", "B", "SER", 5, 3.0),
        atom("OG", "B", "SER", 5, 4.0),
        atom("CB", "C", "THR", 5, 5.0),
        atom("CG2", "C", "THR", 5, 6.0),
        atom("CA", "B", "GLY", 6, 7.0),
        atom("CA", "C", "GLY", 6, 8.0),
    ];
    let scene = from_bytes(text.concat().as_bytes(), Format::Pdb, "test").expect("atoms");
    let centres: Vec<f32> = scene.spheres().iter().map(|sphere| sphere.centre.x).collect();
    assert_eq!(centres.len(), 4);
    // The atoms lie at 1, 2, 4 and 7, so the steps between them are 1, 2 and 3.
    let step = centres[1] - centres[0];
    let steps: Vec<f32> = centres.windows(2).map(|pair| (pair[1] - pair[0]) / step).collect();
    assert!(steps.iter().zip([1.0, 2.0, 3.0]).all(|(found, expected)| (found - expected).abs() < 1e-4), "{steps:?}");
}
