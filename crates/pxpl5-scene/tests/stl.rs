//! STL files made by writers of this test, ASCII and binary. Expected values are the numbers that were written.

use glam::Vec3;
use pxpl5_scene::config::DEFAULT_COLOUR;
use pxpl5_scene::{Format, Placement, Scene, placed_from_bytes};
use pxpl5_sim::parameters::{FileError, FileErrorKind};

type Triangle = [[f32; 3]; 3];

const TWO: [Triangle; 2] =
    [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0.0, 0.0, 0.0], [0.0, 0.0, 2.5], [1.0, 0.0, 0.0]]];

fn binary(header: &str, triangles: &[Triangle]) -> Vec<u8> {
    let mut file = header.as_bytes().to_vec();
    file.resize(80, b' ');
    file.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        // Many programs write normals that are not numbers for thin triangles.
        let normal = [f32::NAN; 3];
        [&normal, &corners[0], &corners[1], &corners[2]]
            .iter()
            .for_each(|v| v.iter().for_each(|x| file.extend(x.to_le_bytes())));
        file.extend([0, 0]);
    }
    file
}

fn text(triangles: &[Triangle], end: &str) -> String {
    let mut text = format!("solid a name with spaces{end}");
    for corners in triangles {
        text += &format!("  facet normal 0 0 nan{end}    outer loop{end}");
        corners.iter().for_each(|[x, y, z]| text += &format!("      vertex {x} {y:e} {z}{end}"));
        text += &format!("    endloop{end}  endfacet{end}");
    }
    text + "endsolid a name with spaces" + end
}

fn read(bytes: impl AsRef<[u8]>) -> Result<Scene, FileError> {
    placed_from_bytes(bytes.as_ref(), Format::Stl, "test", Placement::AsInFile)
}

fn assert_is_two(file: impl AsRef<[u8]>) {
    let scene = read(file).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.triangles(), [[0, 1, 2], [3, 4, 5]]);
    for (vertex, corner) in scene.vertices().iter().zip(TWO.as_flattened()) {
        assert_eq!((vertex.position, vertex.colour), (Vec3::from_array(*corner), DEFAULT_COLOUR));
    }
    // Each triangle is flat: the first triangle faces +z, the second triangle +y.
    let normals: Vec<Vec3> = scene.vertices().iter().map(|vertex| vertex.normal).collect();
    assert_eq!(normals, [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::Y, Vec3::Y, Vec3::Y]);
    assert!(scene.warnings().is_empty(), "{:?}", scene.warnings());
}

#[test]
fn ascii_and_binary_files_have_the_same_flat_triangles() {
    assert_is_two(binary("made by a test", &TWO));
    for end in ["\n", "\r\n", "\r"] {
        assert_is_two(text(&TWO, end));
    }
    assert_is_two(text(&TWO, "\n").to_uppercase());
    assert_is_two(text(&TWO, "\n").replace("endsolid a name with spaces\n", ""));
    assert_is_two(text(&TWO[..1], "\n") + &text(&TWO[1..], "\n"));
}

#[test]
fn a_binary_file_whose_header_begins_like_text_is_binary() {
    assert_is_two(binary("solid", &TWO));
    let mut marked = binary("", &TWO);
    marked[..2].copy_from_slice(&[0xff, 0xfe]);
    assert_is_two(marked);
}

#[test]
fn bytes_after_the_last_binary_triangle_give_a_warning() {
    for header in ["x", "solid", "solid facet normal"] {
        let scene = read([&binary(header, &TWO)[..], b"x"].concat()).expect("it is sound");
        assert_eq!((scene.triangles().len(), scene.warnings().len()), (2, 1), "{header}");
        assert!(scene.warnings()[0].contains("1 byte after the last triangle"), "{:?}", scene.warnings());
    }
}

#[test]
fn words_of_text_may_be_separated_by_any_white_space() {
    let good = text(&TWO, "\n");
    for text in [
        good.split_whitespace().collect::<Vec<_>>().join(" "),
        good.replace(" a name with spaces", "").split_whitespace().collect::<Vec<_>>().join("\n"),
        good.replace("vertex", "vertex\n"),
        good.replace("loop\n", "loop "),
        good.replace("facet normal 0 0 nan", "facet\tnormal\x0c"),
        good.replace("endloop", "end loop").replace("endfacet", "end facet").replace("endsolid", "end solid"),
        good.replace("a name with spaces", "a solid facet"),
        good.clone() + "\0\0\0",
    ] {
        assert_is_two(text);
    }
}

#[test]
fn attributes_of_binary_triangles_give_a_warning() {
    let mut file = binary("colours", &TWO);
    *file.last_mut().expect("it has bytes") = 1;
    assert_eq!(read(file).expect("it is sound").warnings().len(), 1);
}

#[test]
fn errors_state_the_position_and_the_expected_value() {
    let good = text(&TWO, "\n");
    let whole = binary("x", &TWO);
    let mut nan = whole.clone();
    nan[84 + 12 + 4..84 + 12 + 8].copy_from_slice(&f32::NAN.to_le_bytes());
    for (file, expected) in [
        (
            good.replace("outer loop", "inner loop").into_bytes(),
            "line 3: expected \"outer loop\", found \"inner loop\"",
        ),
        (good.replace("vertex 1 0e0 0", "vertex 1 q 0").into_bytes(), "line 5: expected a number for y, found \"q\""),
        (
            good.replace("vertex 1 0e0 0", "vertex 1 0").into_bytes(),
            "line 6: expected a number for z, found \"vertex\"",
        ),
        (good.replace("vertex 1 0e0 0", "vertex 1 inf 0").into_bytes(), "line 5: expected a coordinate between"),
        (
            good.replacen("    endloop", "      vertex 1 1 1", 1).into_bytes(),
            "line 7: expected \"endloop\" after three vertices",
        ),
        (b"solid x\nendsolid x\n".to_vec(), "expected at least one triangle, found none"),
        (binary("x", &[]), "expected at least one triangle, found none"),
        (whole[..whole.len() - 1].to_vec(), "byte 84: expected 2 triangles in 184 bytes, found 183 bytes"),
        ([&binary("x", &[])[..], b"more"].concat(), "byte 84: expected the end of the file behind the last triangle"),
        (b"hello".to_vec(), "byte 0: expected text that begins with \"solid\", or a binary header of 84 bytes"),
        (nan, "byte 96: expected a coordinate between -1e15 and 1e15, found NaN"),
    ] {
        let error = read(file).err().map(|error| error.to_string()).expect("refused");
        assert!(error.contains(expected), "{error:?} has no {expected:?}");
    }
    let cut = good.split_inclusive('\n').take(4).collect::<String>();
    assert!(matches!(read(cut), Err(ref error) if error.kind == FileErrorKind::Truncated));
    // A header that announces 4,294,967,295 triangles takes no memory for them.
    let mut huge = whole;
    huge[80..84].fill(255);
    assert!(matches!(read(huge), Err(ref error) if error.kind == FileErrorKind::Truncated));
}
