//! The JSON of a glTF file. An object is parsed when the importer uses it, so unused parts may have any form.

use std::collections::BTreeMap;

use pxpl5_sim::parameters::FileError;
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::value::RawValue;

use crate::import::Source;

/// Extensions that compress meshes, so that the file has no plain numbers.
pub(super) const COMPRESSION: [&str; 3] =
    ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// The text of each item in a list of the file.
pub(super) type List<'a> = Vec<&'a RawValue>;

/// The name of each extension of an object.
pub(super) type Extensions = Option<BTreeMap<String, IgnoredAny>>;

/// The parts of a file by their names.
pub(super) struct Root<'a> {
    /// Index of the default scene.
    pub(super) scene: Option<Whole>,
    lists: BTreeMap<&'static str, List<'a>>,
}

impl<'a> Root<'a> {
    const LISTS: [&'static str; 7] = ["scenes", "nodes", "meshes", "materials", "accessors", "bufferViews", "buffers"];
    /// Lists of which only the length or the names matter. In another form they count as empty.
    const UNREAD: [&'static str; 4] = ["textures", "animations", "extensionsUsed", "extensionsRequired"];

    pub(super) fn of(source: &Source<'_>, parts: &BTreeMap<String, &'a RawValue>) -> Result<Self, FileError> {
        let mut lists = BTreeMap::new();
        for name in Self::LISTS.into_iter().filter(|name| parts.contains_key(*name)) {
            lists.insert(name, parsed::<Option<List<'a>>>(source, name, parts[name])?.unwrap_or_default());
        }
        for name in Self::UNREAD.into_iter().filter(|name| parts.contains_key(*name)) {
            lists.insert(name, serde_json::from_str(parts[name].get()).unwrap_or_default());
        }
        let scene = parts.get("scene").map(|scene| parsed::<Option<Whole>>(source, "scene", scene)).transpose()?;
        Ok(Self { scene: scene.flatten(), lists })
    }

    pub(super) fn list(&self, name: &str) -> &[&'a RawValue] {
        self.lists.get(name).map_or(&[], Vec::as_slice)
    }

    /// Returns the texts in a list. Items that are no texts are left out.
    pub(super) fn names(&self, name: &str) -> impl Iterator<Item = String> {
        self.list(name).iter().filter_map(|name| serde_json::from_str(name.get()).ok())
    }
}

/// A whole number from 0 on. Some programs write it with a decimal point, as in `3.0`.
#[derive(Clone, Copy, Default, Deserialize)]
#[serde(try_from = "f64")]
pub(super) struct Whole(pub(super) usize);

impl TryFrom<f64> for Whole {
    type Error = String;

    fn try_from(number: f64) -> Result<Self, String> {
        // A number beyond the greatest index becomes the greatest index, at which no list has an item.
        let is_whole = number >= 0.0 && number.fract() == 0.0;
        is_whole
            .then_some(Self(number as usize))
            .ok_or_else(|| format!("{number}, which is not a whole number from 0 on"))
    }
}

#[derive(Deserialize)]
pub(super) struct SceneNodes {
    pub(super) nodes: Option<Vec<Whole>>,
}

#[derive(Deserialize)]
pub(super) struct Node {
    pub(super) children: Option<Vec<Whole>>,
    pub(super) mesh: Option<Whole>,
    pub(super) skin: Option<IgnoredAny>,
    pub(super) matrix: Option<[f64; 16]>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
    pub(super) extensions: Extensions,
}

#[derive(Deserialize)]
pub(super) struct Mesh<'a> {
    #[serde(borrow)]
    pub(super) primitives: Option<List<'a>>,
}

#[derive(Deserialize)]
pub(super) struct Primitive<'a> {
    pub(super) attributes: Attributes,
    pub(super) indices: Option<Whole>,
    pub(super) material: Option<Whole>,
    pub(super) mode: Option<Whole>,
    #[serde(borrow)]
    pub(super) targets: Option<&'a RawValue>,
    pub(super) extensions: Extensions,
}

#[derive(Deserialize)]
pub(super) struct Attributes {
    #[serde(rename = "POSITION")]
    pub(super) positions: Option<Whole>,
    #[serde(rename = "NORMAL")]
    pub(super) normals: Option<Whole>,
    #[serde(rename = "COLOR_0")]
    pub(super) colours: Option<Whole>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<Whole>,
    #[serde(default)]
    pub(super) byte_offset: Whole,
    pub(super) component_type: Whole,
    pub(super) count: Whole,
    #[serde(rename = "type")]
    pub(super) shape: String,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) sparse: Option<Sparse>,
}

#[derive(Deserialize)]
pub(super) struct Sparse {
    pub(super) count: Whole,
    pub(super) indices: SparseItems,
    pub(super) values: SparseItems,
}

/// Place of the indices or of the values of a sparse accessor. Only indices have a type of their own.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseItems {
    pub(super) buffer_view: Whole,
    #[serde(default)]
    pub(super) byte_offset: Whole,
    #[serde(default)]
    pub(super) component_type: Whole,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct View {
    pub(super) buffer: Whole,
    #[serde(default)]
    pub(super) byte_offset: Whole,
    pub(super) byte_length: Whole,
    pub(super) byte_stride: Option<Whole>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
    pub(super) byte_length: Whole,
}

/// Parses an object whose path in the file is `part`.
pub(super) fn parsed<'a, T: Deserialize<'a>>(
    source: &Source<'_>,
    part: &str,
    text: &'a RawValue,
) -> Result<T, FileError> {
    serde_json::from_str(text.get()).map_err(|error| {
        // The position in the error counts from the beginning of the object, so it is left out.
        let message = error.to_string();
        source.part(part, "the form of glTF 2.0", message.split(" at line ").next().unwrap_or_default())
    })
}
