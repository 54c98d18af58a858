//! glTF files made by a writer of this test. Expected values are the numbers that the writer was given. Transforms of
//! the glTF 2.0 specification are worked out by hand. Colours come from the sRGB transfer function.

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use pxpl5_scene::config::DEFAULT_COLOUR;
use pxpl5_scene::{Format, Placement, Scene, load_placed, placed_from_bytes};
use pxpl5_sim::parameters::{FileError, FileErrorKind};
use serde_json::{Value, json};

/// A writer of glTF files that shares no code with the reader.
#[derive(Default)]
struct Writer {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Writer {
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.views.push(json!({"buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len()}));
        self.binary.extend(bytes);
        self.views.len() - 1
    }

    fn accessor(&mut self, bytes: &[u8], count: usize, kind: u32, shape: &str) -> usize {
        let view = self.view(bytes);
        self.accessors.push(json!({"bufferView": view, "componentType": kind, "count": count, "type": shape}));
        self.accessors.len() - 1
    }

    fn vectors(&mut self, vectors: &[[f32; 3]]) -> usize {
        let bytes: Vec<u8> = vectors.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(&bytes, vectors.len(), 5126, "VEC3")
    }

    fn shorts(&mut self, indices: &[u16]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(&bytes, indices.len(), 5123, "SCALAR")
    }

    /// Returns the JSON of a file with one mesh in one node.
    fn one_mesh(&self, primitive: Value) -> Value {
        self.document(json!([{"primitives": [primitive]}]), json!([{"mesh": 0}]), json!([0]))
    }

    fn document(&self, meshes: Value, nodes: Value, roots: Value) -> Value {
        json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": roots}], "nodes": nodes, "meshes": meshes,
            "accessors": self.accessors, "bufferViews": self.views, "buffers": [{"byteLength": self.binary.len()}],
        })
    }

    fn binary(&self, document: &Value) -> Vec<u8> {
        binary_file(&document.to_string(), &self.binary)
    }

    /// Returns a text file in which the buffer is a data uri.
    fn text(&self, mut document: Value) -> Vec<u8> {
        document["buffers"][0]["uri"] = format!("data:application/octet-stream;base64,{}", base64(&self.binary)).into();
        document.to_string().into_bytes()
    }
}

fn binary_file(json: &str, binary: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], by: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), by);
        bytes
    };
    let (json, binary) = (padded(json.as_bytes(), b' '), padded(binary, 0));
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((28 + json.len() as u32 + binary.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", binary)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}

/// Encodes bytes by RFC 4648.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let group = |three: &[u8]| {
        let word = three.iter().chain([&0, &0]).take(3).fold(0, |word, byte| word << 8 | usize::from(*byte));
        let digit = |n: usize| if n <= three.len() { char::from(DIGITS[word >> (18 - 6 * n) & 63]) } else { '=' };
        (0..4).map(digit).collect::<String>()
    };
    bytes.chunks(3).map(group).collect()
}

fn read(bytes: &[u8]) -> Result<Scene, FileError> {
    placed_from_bytes(bytes, Format::Gltf, "test", Placement::AsInFile)
}

fn scene(bytes: &[u8]) -> Scene {
    read(bytes).unwrap_or_else(|error| panic!("{error}"))
}

fn corners(scene: &Scene) -> Vec<[Vec3; 3]> {
    scene.triangles().iter().map(|t| t.map(|corner| scene.vertices()[corner as usize].position)).collect()
}

fn message(bytes: &[u8]) -> String {
    read(bytes).err().map(|error| error.to_string()).expect("refused")
}

const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

fn at(n: usize) -> Vec3 {
    Vec3::from_array(SQUARE[n])
}

/// A square of two indexed triangles with normals.
fn square() -> (Writer, Value) {
    let mut writer = Writer::default();
    let positions = writer.vectors(&SQUARE);
    let normals = writer.vectors(&[[0.0, 0.0, 1.0]; 4]);
    let indices = writer.shorts(&[0, 1, 2, 0, 2, 3]);
    let document =
        writer.one_mesh(json!({"attributes": {"POSITION": positions, "NORMAL": normals}, "indices": indices}));
    (writer, document)
}

#[test]
fn indexed_triangles_share_the_vertices_of_their_file_in_both_containers() {
    let (writer, document) = square();
    for file in [writer.binary(&document), writer.text(document.clone())] {
        let scene = scene(&file);
        assert_eq!(scene.triangles(), [[0, 1, 2], [0, 2, 3]]);
        let vertices = scene.vertices();
        assert_eq!(vertices.len(), 4);
        for (n, vertex) in vertices.iter().enumerate() {
            assert_eq!((vertex.position, vertex.normal, vertex.colour), (at(n), Vec3::Z, DEFAULT_COLOUR));
        }
        assert!(scene.warnings().is_empty(), "{:?}", scene.warnings());
    }
}

#[test]
fn triangles_without_normals_are_flat_and_share_no_vertex() {
    let mut writer = Writer::default();
    // Two sides of a roof.
    let positions = writer.vectors(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let indices = writer.shorts(&[0, 1, 2, 0, 3, 1]);
    let scene =
        scene(&writer.binary(&writer.one_mesh(json!({"attributes": {"POSITION": positions}, "indices": indices}))));
    assert_eq!(scene.vertices().len(), 6);
    let normals: Vec<Vec3> = scene.vertices().iter().map(|vertex| vertex.normal).collect();
    assert_eq!(normals, [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::Y, Vec3::Y, Vec3::Y]);
}

#[test]
fn corners_without_indices_make_triangles_strips_and_fans_as_the_specification_says() {
    let fan = [[0, 1, 2], [0, 2, 3]];
    for (mode, order, expected) in [
        (4, vec![0, 1, 2, 0, 2, 3], fan),
        // A strip turns every second triangle, so that all are anticlockwise.
        (5, vec![3, 0, 2, 1], [[3, 0, 2], [0, 1, 2]]),
        (6, vec![0, 1, 2, 3], fan),
    ] {
        for is_indexed in [true, false] {
            let mut writer = Writer::default();
            let indices: Vec<u16> = order.iter().map(|n| *n as u16).collect();
            let in_order: Vec<[f32; 3]> = order.iter().map(|n| SQUARE[*n]).collect();
            let (positions, indices) = match is_indexed {
                true => (writer.vectors(&SQUARE), Some(writer.shorts(&indices))),
                false => (writer.vectors(&in_order), None),
            };
            let mut primitive = json!({"attributes": {"POSITION": positions}, "mode": mode});
            if let Some(indices) = indices {
                primitive["indices"] = indices.into();
            }
            let found = corners(&scene(&writer.binary(&writer.one_mesh(primitive))));
            // A triangle may begin at any of its corners.
            let begin = |t: [Vec3; 3]| (0..3).map(|n| [t[n], t[(n + 1) % 3], t[(n + 2) % 3]]).collect::<Vec<_>>();
            assert_eq!(found.len(), 2);
            for (found, expected) in found.into_iter().zip(expected) {
                assert!(begin(found).contains(&expected.map(at)), "{mode}: {found:?} for {expected:?}");
            }
        }
    }
}

#[test]
fn triangles_that_only_join_parts_of_a_strip_are_ignored() {
    let mut writer = Writer::default();
    let positions = writer.vectors(&SQUARE);
    let indices = writer.shorts(&[0, 1, 2, 2, 0, 0, 2, 3]);
    let primitive = json!({"attributes": {"POSITION": positions}, "indices": indices, "mode": 5});
    assert_eq!(scene(&writer.binary(&writer.one_mesh(primitive))).triangles().len(), 2);
}

#[test]
fn indices_of_one_two_and_four_bytes_are_read() {
    for (kind, bytes) in [
        (5121, vec![0, 1, 2]),
        (5123, [0_u16, 1, 2].iter().flat_map(|n| n.to_le_bytes()).collect()),
        (5125, [0_u32, 1, 2].iter().flat_map(|n| n.to_le_bytes()).collect()),
    ] {
        let mut writer = Writer::default();
        let positions = writer.vectors(&SQUARE);
        let indices = writer.accessor(&bytes, 3, kind, "SCALAR");
        let primitive = json!({"attributes": {"POSITION": positions}, "indices": indices});
        assert_eq!(corners(&scene(&writer.binary(&writer.one_mesh(primitive)))), [[0, 1, 2].map(at)]);
    }
}

/// A child is turned by 90 degrees about z, its parent is scaled by 2 in x, and then moved by 10 in y.
#[test]
fn transforms_of_nodes_apply_from_the_child_to_the_root() {
    let mut writer = Writer::default();
    let positions = writer.vectors(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let normals = writer.vectors(&[[1.0, 1.0, 0.0]; 3]);
    let meshes = json!([{"primitives": [{"attributes": {"POSITION": positions, "NORMAL": normals}}]}]);
    let half = 0.5_f64.sqrt();
    let turn = json!([0.0, 0.0, half, half]);
    // The same transform of the parent as a matrix, in columns.
    let matrix = json!([2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 10, 0, 1]);
    for parent in [
        json!({"children": [1], "scale": [2, 1, 1], "translation": [0, 10, 0]}),
        json!({"children": [1], "matrix": matrix}),
    ] {
        let nodes = json!([parent, {"mesh": 0, "rotation": turn}]);
        let scene = scene(&writer.binary(&writer.document(meshes.clone(), nodes, json!([0]))));
        let expected = [[0.0, 11.0, 0.0], [-2.0, 10.0, 0.0], [0.0, 10.0, 1.0]];
        for (vertex, expected) in scene.vertices().iter().zip(expected) {
            assert!(vertex.position.distance(Vec3::from_array(expected)) < 1e-5, "{vertex:?} {expected:?}");
            // The normal (1, 1, 0) turns into (-1, 1, 0). The scale divides its x by 2.
            let normal = DVec3::new(-0.5, 1.0, 0.0).normalize().as_vec3();
            assert!(vertex.normal.distance(normal) < 1e-6, "{vertex:?}");
        }
    }
}

#[test]
fn a_mirroring_transform_leaves_triangles_anticlockwise() {
    let mut writer = Writer::default();
    let positions = writer.vectors(&SQUARE[..3]);
    let normals = writer.vectors(&[[0.0, 0.0, 1.0]; 3]);
    for attributes in [json!({"POSITION": positions}), json!({"POSITION": positions, "NORMAL": normals})] {
        let nodes = json!([{"mesh": 0, "scale": [-1, 1, 1]}]);
        let meshes = json!([{"primitives": [{"attributes": attributes}]}]);
        let scene = scene(&writer.binary(&writer.document(meshes, nodes, json!([0]))));
        let [a, b, c] = corners(&scene)[0];
        // The square faces +z, and its mirror image in x does too.
        assert!((b - a).cross(c - a).z > 0.0);
        assert!(scene.vertices().iter().all(|vertex| vertex.normal == Vec3::Z));
    }
}

#[test]
fn a_mesh_in_two_nodes_is_drawn_twice_and_a_node_outside_the_scene_is_not_drawn() {
    let (writer, mut document) = square();
    document["nodes"] = json!([{"mesh": 0}, {"mesh": 0, "translation": [5, 0, 0]}, {"mesh": 0}]);
    document["scenes"] = json!([{"nodes": [2]}, {"nodes": [0, 1]}]);
    document["scene"] = 1.into();
    let scene = scene(&writer.binary(&document));
    assert_eq!((scene.triangles().len(), scene.vertices().len()), (4, 8));
    assert_eq!(scene.vertices()[4].position, Vec3::new(5.0, 0.0, 0.0));
}

/// Returns 8 bits of sRGB by the definition in IEC 61966-2-1.
fn srgb(linear: f64) -> u8 {
    let part = if linear <= 0.003_130_8 { linear * 12.92 } else { linear.powf(1.0 / 2.4) * 1.055 - 0.055 };
    (part * 255.0).round() as u8
}

#[test]
fn colours_are_the_material_times_the_vertex_in_linear_light() {
    let mut writer = Writer::default();
    let positions = writer.vectors(&SQUARE[..3]);
    let floats = writer.vectors(&[[1.0, 0.5, 0.25], [0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]);
    let bytes = writer.accessor(&[255, 51, 0, 255, 0, 0, 0, 0, 255, 255, 255, 128], 3, 5121, "VEC4");
    writer.accessors[bytes]["normalized"] = true.into();
    let material = json!({"pbrMetallicRoughness": {"baseColorFactor": [0.5, 1.0, 0.001, 1.0]}});
    let with = |attributes: Value, material_of: Option<usize>| {
        let mut primitive = json!({"attributes": attributes});
        if let Some(number) = material_of {
            primitive["material"] = number.into();
        }
        let mut document = writer.one_mesh(primitive);
        document["materials"] = json!([material, {}]);
        scene(&writer.binary(&document)).vertices()[0].colour
    };
    let plain = json!({"POSITION": positions});
    assert_eq!(with(plain.clone(), None), DEFAULT_COLOUR);
    assert_eq!(with(plain.clone(), Some(0)), [srgb(0.5), srgb(1.0), srgb(0.001)]);
    assert_eq!(with(plain, Some(1)), [255; 3], "the default base colour is white");
    let coloured = json!({"POSITION": positions, "COLOR_0": floats});
    assert_eq!(with(coloured.clone(), None), [srgb(1.0), srgb(0.5), srgb(0.25)]);
    assert_eq!(with(coloured, Some(0)), [srgb(0.5), srgb(0.5), srgb(0.000_25)]);
    assert_eq!(with(json!({"POSITION": positions, "COLOR_0": bytes}), None), [255, srgb(0.2), 0]);
}

#[test]
fn quantized_interleaved_and_sparse_numbers_are_read() {
    // Positions of three signed bytes with a stride of 4, as KHR_mesh_quantization allows.
    let mut writer = Writer::default();
    let positions = writer.accessor(&[0, 0, 0, 9, 127, 0, 0, 9, 0, 127, 0, 9], 3, 5120, "VEC3");
    writer.views[0]["byteStride"] = 4.into();
    writer.accessors[positions]["normalized"] = true.into();
    let mut document = writer.one_mesh(json!({"attributes": {"POSITION": positions}}));
    document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    assert_eq!(corners(&scene(&writer.binary(&document))), [[at(0), at(1), at(3)]]);
    // A sparse accessor without a buffer view: all vertices are zero, except for two replaced vertices.
    let mut writer = Writer::default();
    let indices = writer.view(&[1, 2]);
    let values: Vec<u8> = [SQUARE[1], SQUARE[3]].as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    let values = writer.view(&values);
    writer.accessors.push(json!({"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {
        "count": 2, "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}}}));
    let file = writer.binary(&writer.one_mesh(json!({"attributes": {"POSITION": 0}})));
    assert_eq!(corners(&scene(&file)), [[at(0), at(1), at(3)]]);
}

#[test]
fn a_buffer_is_read_from_a_file_beside_the_model_and_from_no_other_folder() {
    let folder = std::env::temp_dir().join(format!("pxpl5-gltf-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("inner")).expect("a temporary folder");
    let (writer, mut document) = square();
    std::fs::write(folder.join("inner/a b.bin"), &writer.binary).expect("written");
    std::fs::write(folder.join("outer.bin"), &writer.binary).expect("written");
    let path = folder.join("inner/model.gltf");
    let mut load = |uri: &str| {
        document["buffers"][0]["uri"] = uri.into();
        std::fs::write(&path, document.to_string()).expect("written");
        load_placed(&path, Placement::AsInFile).map(|scene| scene.triangles().len()).map_err(|error| error.to_string())
    };
    assert_eq!(load("a%20b.bin"), Ok(2));
    for name in ["10%.bin", "50%20.bin", "%zz.bin"] {
        std::fs::write(folder.join("inner").join(name), &writer.binary).expect("written");
        assert_eq!(load(name), Ok(2), "{name}");
    }
    for uri in ["../outer.bin", "%2e%2e/outer.bin", "/etc/hostname", "https://example.org/a.bin", "file:a%20b.bin", ""]
    {
        let error = load(uri).expect_err("refused");
        assert!(error.contains("buffers[0]: expected data inside the file, or a relative path"), "{uri}: {error}");
    }
    let error = load("missing.bin").expect_err("refused");
    assert!(error.contains("buffers[0]: expected a readable file missing.bin"), "{error}");
    let error = load(".").expect_err("refused");
    assert!(error.contains("no regular file"), "{error}");
    std::fs::remove_dir_all(folder).expect("it is there");
}

#[test]
fn unread_parts_cause_a_warning() {
    let (writer, mut document) = square();
    document["textures"] = json!([{"source": 0}]);
    document["images"] = json!([{"uri": "a.png"}]);
    document["meshes"][0]["primitives"].as_array_mut().expect("a list").push(json!({"attributes": {}, "mode": 1}));
    document["nodes"][0]["skin"] = 0.into();
    document["skins"] = json!([{"joints": [0]}]);
    let warnings = scene(&writer.binary(&document)).warnings().join("\n");
    for what in ["1 primitive: points and lines", "1 texture: not read", "1 skin: not applied"] {
        assert!(warnings.contains(what), "{warnings}");
    }
}

/// Changes that a file may have without a change of its picture.
#[test]
fn unused_parts_of_a_file_may_have_any_form() {
    let (writer, good) = square();
    let expected = scene(&writer.binary(&good));
    for extras in [json!(42), json!("text"), json!([1, "a"]), json!(true), Value::Null, json!({"a": {}})] {
        let mut document = good.clone();
        for part in ["/asset", "/scenes/0", "/nodes/0", "/meshes/0", "/meshes/0/primitives/0", "/accessors/0"] {
            document.pointer_mut(part).expect("a part")["extras"] = extras.clone();
        }
        document["extras"] = extras;
        assert_eq!(scene(&writer.binary(&document)), expected);
    }
    for (part, value) in [
        ("/scenes", json!([{"nodes": [0]}, {"name": 7}])),
        ("/skins", json!({})),
        ("/cameras", json!([{}])),
        ("/images", json!("none")),
        ("/nodes", json!([{"mesh": 0}, {"mesh": "none", "rotation": 7}])),
        ("/scene", json!(0.0)),
        ("/nodes/0/mesh", json!(0.0)),
        ("/accessors/0/count", json!(4.0)),
        ("/accessors/0/componentType", json!(5126.0)),
        ("/accessors/0/name", json!({})),
        ("/extensionsUsed", Value::Null),
    ] {
        assert_eq!(scene(&writer.binary(&changed(&good, json!({part: value})))), expected, "{part}");
    }
    // The default scene may be another one, and the first scene need not have nodes.
    let mut document = good.clone();
    document["scenes"] = json!([{"name": "empty"}, {"nodes": [0]}]);
    document["scene"] = 1.into();
    assert_eq!(scene(&writer.binary(&document)), expected);
    // Animations are counted, whatever they contain.
    document["animations"] = json!([{"channels": [{"target": {"path": "weights"}, "sampler": 0}], "samplers": []}]);
    assert_eq!(scene(&writer.binary(&document)).warnings(), ["1 animation: not read"]);
    // Names in another encoding, base64 without padding, and JSON that is padded with zeros.
    let text = document.to_string().replace("\"empty\"", "\"\u{fffd}\"");
    let latin1: Vec<u8> = text.split('\u{fffd}').map(str::as_bytes).collect::<Vec<_>>().join(&0xfc);
    let mut file = binary_file("", &writer.binary);
    file.splice(20..20, [&latin1[..], &[0; 4][latin1.len() % 4..]].concat());
    let length = (
        file.len() as u32,
        latin1.len().next_multiple_of(4) as u32 + if latin1.len().is_multiple_of(4) { 4 } else { 0 },
    );
    file[8..12].copy_from_slice(&length.0.to_le_bytes());
    file[12..16].copy_from_slice(&length.1.to_le_bytes());
    assert_eq!(scene(&file).triangles(), expected.triangles());
    let mut unpadded = writer.binary.clone();
    unpadded.push(0);
    let writer = Writer { binary: unpadded, ..writer };
    let text = String::from_utf8(writer.text(good)).expect("text");
    assert!(text.contains("==") && scene(text.replace("==", "").as_bytes()) == expected);
}

#[test]
fn extensions_that_are_not_read_cause_a_warning_with_their_names() {
    let (writer, good) = square();
    let mut document = good.clone();
    document["extensionsUsed"] =
        json!(["EXT_mesh_gpu_instancing", "KHR_materials_unlit", "KHR_draco_mesh_compression"]);
    document["nodes"][0]["extensions"] = json!({"VENDOR_hidden": {}});
    let warnings = scene(&writer.binary(&document)).warnings().join("\n");
    for name in ["EXT_mesh_gpu_instancing", "VENDOR_hidden"] {
        assert!(warnings.contains(&format!("the extension {name} is not read")), "{warnings}");
    }
    assert_eq!(warnings.lines().count(), 2, "{warnings}");
    // The older way to state a colour is read.
    let mut document = good;
    document["meshes"][0]["primitives"][0]["material"] = 0.into();
    let red = json!({"diffuseFactor": [1.0, 0.0, 0.0, 1.0]});
    document["materials"] = json!([{"extensions": {"KHR_materials_pbrSpecularGlossiness": red}}]);
    assert!(scene(&writer.binary(&document)).vertices().iter().all(|vertex| vertex.colour == [255, 0, 0]));
}

/// Replaces parts of a document, or adds them.
fn changed(document: &Value, changes: Value) -> Value {
    let mut document = document.clone();
    for (part, value) in changes.as_object().expect("parts") {
        match document.pointer_mut(part) {
            Some(there) => *there = value.clone(),
            None => {
                let (above, name) = part.rsplit_once('/').expect("a path");
                document.pointer_mut(above).expect("a part")[name] = value.clone();
            }
        }
    }
    document
}

#[test]
fn errors_name_the_part_of_the_file() {
    let (writer, good) = square();
    let refused = |changes: Value, text: &str| {
        let error = message(&writer.binary(&changed(&good, changes)));
        text.split('|').for_each(|part| assert!(error.contains(part), "{error:?} has no {part:?}"));
    };
    refused(json!({"/meshes": [{"primitives": []}]}), "at least one triangle");
    refused(json!({"/scenes": [{"nodes": []}]}), "at least one triangle");
    refused(json!({"/meshes/0/primitives/0/mode": 0}), "at least one triangle");
    refused(json!({"/buffers": []}), "buffers[0]: expected a buffer with this index, found 0 buffers");
    refused(json!({"/buffers/0/byteLength": 4000}), "buffers[0]: expected 4000 bytes, found 108");
    let no_view = json!({"componentType": 5126, "count": 4, "type": "VEC3"});
    for name in ["KHR_draco_mesh_compression", "EXT_meshopt_compression"] {
        let required = json!({"/extensionsRequired": ["KHR_materials_unlit", name]});
        refused(required, &format!("extensionsRequired[1]: expected a mesh without compression|{name}"));
        let found = format!("found none in a file that uses|{name}");
        let no_positions = json!({"/extensionsUsed": [name], "/meshes/0/primitives/0/attributes": {}});
        refused(no_positions, &format!("meshes[0].primitives[0].attributes: expected POSITION, {found}"));
        let no_view = json!({"/extensionsUsed": [name], "/accessors/0": no_view});
        refused(no_view, &format!("accessors[0].bufferView: expected a buffer view, {found}"));
    }
    refused(json!({"/extensionsRequired": ["VENDOR_x"]}), "extensionsRequired[0]|VENDOR_x");
    refused(json!({"/asset/version": "1.0"}), "asset.version: expected glTF 2.0, found glTF \"1.0\"");
    for version in [json!("1.0"), json!(1.0), json!("1")] {
        // In glTF 1.0 the lists are objects.
        let old = json!({"/asset": {"version": version}, "/nodes": {"a": {}}});
        refused(old, "asset.version: expected glTF 2.0, found glTF \"1");
    }
    refused(json!({"/asset": null}), "asset.version: expected glTF 2.0, found no version");
    refused(json!({"/nodes/0/mesh": 0.5}), "nodes[0]: expected the form of glTF 2.0, found|0.5");
    refused(json!({"/scene": 7}), "scene: expected a scene with the index 7, found 1 scenes");
    refused(json!({"/scenes/0/nodes": [9]}), "nodes[9]: expected a node with this index, found 1 nodes");
    refused(json!({"/nodes/0/mesh": 3}), "meshes[3]: expected an item of meshes with this index, found 1 meshes");
    refused(json!({"/nodes/0/children": [0]}), "nodes[0]: expected a node with at most one parent");
    refused(json!({"/nodes/0/rotation": [0, 0, 0, 0]}), "nodes[0].rotation");
    let primitive =
        |key: &str, value: u32, text| refused(json!({format!("/meshes/0/primitives/0/{key}"): value}), text);
    primitive("indices", 8, "accessors[8]: expected an item of accessors with this index");
    primitive("material", 2, "meshes[0].primitives[0].material|index 2, found 0");
    primitive("mode", 7, "meshes[0].primitives[0].mode: expected 0 to 6");
    refused(json!({"/accessors/2/count": 5}), "three corners for each triangle, found 5 corners");
    refused(json!({"/accessors/0/count": 3}), "attributes.NORMAL: expected 3 items|found 4");
    refused(json!({"/accessors/0/count": u64::MAX}), "accessors[0]: expected|items of 12 bytes");
    refused(json!({"/accessors/0/byteOffset": 4}), "accessors[0]: expected 4 items of 12 bytes");
    refused(json!({"/accessors/0/bufferView": 6}), "bufferViews[6]: expected an item of bufferViews");
    refused(json!({"/accessors/0/type": "VEC2"}), "accessors[0].type: expected one with [3] numbers, found");
    refused(json!({"/accessors/2/componentType": 5126}), "accessors[2].componentType|F32");
    refused(json!({"/bufferViews/1/byteOffset": u64::MAX}), "bufferViews[1]: expected 48 bytes at byte");
    // The vertices have the indices 0 to 3, but the file now contains the index 4.
    let mut writer = Writer::default();
    let positions = writer.vectors(&SQUARE);
    let indices = writer.shorts(&[0, 1, 4]);
    let beyond = writer.one_mesh(json!({"attributes": {"POSITION": positions}, "indices": indices}));
    assert!(
        message(&writer.binary(&beyond))
            .contains("primitives[0].indices: expected an index of one of 4 vertices, found 4")
    );
    let mut writer = Writer::default();
    let positions = writer.vectors(&[[0.0; 3], [f32::NAN, 0.0, 0.0], [0.0; 3]]);
    let error = message(&writer.binary(&writer.one_mesh(json!({"attributes": {"POSITION": positions}}))));
    assert!(
        error.contains("meshes[0].primitives[0].attributes.POSITION: expected coordinates")
            && error.contains("vertex 1")
    );
}

#[test]
fn errors_of_the_gltf_container_name_the_byte_or_line() {
    let (writer, document) = square();
    let good = writer.binary(&document);
    for (change, expected) in [
        (&|file: &mut Vec<u8>| file[4] = 1, "byte 4: expected binary glTF of version 2, found version 1"),
        (&|file: &mut Vec<u8>| file.truncate(200), "byte 8: expected a file of"),
        (
            &|file: &mut Vec<u8>| file[8..12].copy_from_slice(&[3, 0, 0, 0]),
            "byte 8: expected a file of 3 bytes, 12 or more",
        ),
        (
            &|file: &mut Vec<u8>| file[12..16].copy_from_slice(&[255; 4]),
            "byte 12: expected a chunk of 4294967295 bytes",
        ),
        (
            &|file: &mut Vec<u8>| file[16..20].copy_from_slice(b"XXXX"),
            "expected a chunk of the type JSON first, found \"XXXX\"",
        ),
        (&|file: &mut Vec<u8>| file.truncate(10), "expected the length of the file, found the end of the file"),
    ] as [(&dyn Fn(&mut Vec<u8>), &str); 6]
    {
        let mut file = good.clone();
        change(&mut file);
        let error = message(&file);
        assert!(error.contains(expected), "{error:?} has no {expected:?}");
    }
    let error = message(b"{\n\"asset\": {\"version\": \"2.0\"},\n\"nodes\": 7}");
    assert!(error.contains("nodes: expected the form of glTF 2.0, found invalid type"), "{error}");
    // Without the binary chunk, no buffer has bytes.
    let error = message(document.to_string().as_bytes());
    assert!(
        error.contains("buffers[0]: expected a uri, or the binary chunk for the first buffer, found neither"),
        "{error}"
    );
}

#[test]
fn small_files_that_ask_for_much_memory_are_refused() {
    let too_much = |file: &[u8]| matches!(read(file), Err(ref error) if error.kind == FileErrorKind::TooLarge);
    let (writer, mut document) = square();
    document["nodes"] = vec![json!({}); 200_000].into();
    assert!(too_much(&writer.binary(&document)), "many nodes of three bytes");
    let mut document = square().1;
    document["extensionsUsed"] = vec![""; 1_000_000].into();
    assert!(too_much(&writer.binary(&document)), "many empty texts");
    // A sparse accessor of a thousand million vertices, of which the file stores one.
    let mut writer = Writer::default();
    let index = writer.view(&[1]);
    let value = writer.view(&[0; 12]);
    writer.accessors.push(json!({"componentType": 5126, "count": 3_000_000_000_u64, "type": "VEC3", "sparse": {
        "count": 1, "indices": {"bufferView": index, "componentType": 5121}, "values": {"bufferView": value}}}));
    assert!(too_much(&writer.binary(&writer.one_mesh(json!({"attributes": {"POSITION": 0}})))), "many zeros");
    // A mesh that many nodes show.
    let mut writer = Writer::default();
    let positions = writer.vectors(&[SQUARE[0], SQUARE[1], SQUARE[2]].repeat(1_000));
    let meshes = json!([{"primitives": [{"attributes": {"POSITION": positions}}]}]);
    let nodes = vec![json!({"mesh": 0}); 3_000];
    let document = writer.document(meshes, nodes.into(), (0..3_000).collect::<Vec<u32>>().into());
    assert!(too_much(&writer.binary(&document)), "many copies");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Replaces each number of the document by other numbers. Random damage of bytes seldom changes these numbers.
    #[test]
    fn no_number_in_the_document_causes_a_panic(which in 0..64_usize, number: u64, small in 0..9_u64, is_small: bool) {
        let (writer, document) = square();
        let number = if is_small { small } else { number };
        let text = document.to_string();
        let digits = text.char_indices().filter(|(at, c)| c.is_ascii_digit() && !text[..*at].ends_with(|c: char| c.is_ascii_digit()));
        let places: Vec<usize> = digits.map(|(at, _)| at).collect();
        let at = places[which % places.len()];
        let end = text[at..].find(|c: char| !c.is_ascii_digit()).map_or(text.len(), |length| at + length);
        let file = binary_file(&format!("{}{number}{}", &text[..at], &text[end..]), &writer.binary);
        if let Ok(scene) = read(&file) {
            Scene::new(scene.into_parts()).expect("a reader's scene is sound");
        }
    }
}
