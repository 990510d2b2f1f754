//! A GLB in the making: the document, and the buffer that its accessors look into.

use crate::export::{error::ExportError, tree::GENERATOR};
use bytemuck::{NoUninit, cast_slice};
use gltf_json::{
    Accessor, Asset, Buffer, Image, Index, Root, Value,
    accessor::{ComponentType, GenericComponentType, Type},
    buffer::{Target, View},
    image::MimeType,
    validation::{Checked::Valid, USize64},
};

/// Everything in a GLB begins at a multiple of this, bytes.
const ALIGNMENT: usize = 4;
const MAGIC: &[u8; 4] = b"glTF";
const VERSION: u32 = 2;
const JSON_CHUNK: &[u8; 4] = b"JSON";
const BINARY_CHUNK: &[u8; 4] = b"BIN\0";
/// Bytes of the file's header and of the headers of two chunks.
const HEADERS: u64 = 12 + 8 + 8;

/// A document and its buffer.
pub(super) struct GlbBuilder {
    pub root: Root,
    buffer: Vec<u8>,
}

/// What an accessor says of its elements.
pub(super) struct Elements {
    pub component: ComponentType,
    pub kind: Type,
    /// Whether whole numbers stand for 0 to 1.
    pub normalized: bool,
    /// Least and greatest value of each component, where the format wants them.
    pub bounds: Option<[Value; 2]>,
    pub target: Option<Target>,
}

impl Elements {
    /// Of floats, without bounds, as attributes of vertices.
    pub fn floats(kind: Type, target: Option<Target>) -> Self {
        Self { component: ComponentType::F32, kind, normalized: false, bounds: None, target }
    }
}

impl GlbBuilder {
    pub fn new() -> Self {
        let asset = Asset { generator: Some(GENERATOR.to_owned()), ..Asset::default() };
        Self { root: Root { asset, ..Root::default() }, buffer: Vec::new() }
    }

    /// Adds elements to the buffer.
    pub fn accessor<T: NoUninit>(&mut self, items: &[T], elements: Elements) -> Index<Accessor> {
        let Elements { component, kind, normalized, bounds, target } = elements;
        let view = self.view(cast_slice(items), target);
        let [min, max] = bounds.map_or([None, None], |bounds| bounds.map(Some));
        self.root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: USize64::from(items.len()),
            component_type: Valid(GenericComponentType(component)),
            extensions: None,
            extras: None,
            type_: Valid(kind),
            min,
            max,
            name: None,
            normalized,
            sparse: None,
        })
    }

    /// Adds a picture.
    pub fn image(&mut self, name: String, png: &[u8]) -> Index<Image> {
        let view = self.view(png, None);
        self.root.push(Image {
            buffer_view: Some(view),
            mime_type: Some(MimeType("image/png".to_owned())),
            name: Some(name),
            uri: None,
            extensions: None,
            extras: None,
        })
    }

    /// Notes that the file uses an extension.
    pub fn use_extension(&mut self, name: &str) {
        if self.root.extensions_used.iter().all(|used| used != name) {
            self.root.extensions_used.push(name.to_owned());
        }
    }

    fn view(&mut self, bytes: &[u8], target: Option<Target>) -> Index<View> {
        let byte_offset = self.buffer.len();
        self.buffer.extend_from_slice(bytes);
        pad(&mut self.buffer, 0);
        self.root.push(View {
            buffer: Index::new(0),
            byte_length: USize64::from(bytes.len()),
            byte_offset: Some(USize64::from(byte_offset)),
            byte_stride: None,
            name: None,
            target: target.map(Valid),
            extensions: None,
            extras: None,
        })
    }

    /// The file.
    pub fn into_bytes(mut self) -> Result<Vec<u8>, ExportError> {
        self.root.buffers = vec![Buffer {
            byte_length: USize64::from(self.buffer.len()),
            name: None,
            uri: None,
            extensions: None,
            extras: None,
        }];
        let mut json = self.root.to_vec()?;
        pad(&mut json, b' ');
        let length = HEADERS + json.len() as u64 + self.buffer.len() as u64;
        let most = u64::from(u32::MAX);
        if length > most {
            return Err(ExportError::TooLarge { bytes: length, most });
        }
        let mut bytes = Vec::with_capacity(length as usize);
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&(length as u32).to_le_bytes());
        for (kind, chunk) in [(JSON_CHUNK, &json), (BINARY_CHUNK, &self.buffer)] {
            bytes.extend_from_slice(&(chunk.len() as u32).to_le_bytes());
            bytes.extend_from_slice(kind);
            bytes.extend_from_slice(chunk);
        }
        Ok(bytes)
    }
}

fn pad(bytes: &mut Vec<u8>, with: u8) {
    bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), with);
}
