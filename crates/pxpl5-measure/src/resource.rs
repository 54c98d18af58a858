//! The resources that a picture can wait for.

use serde::Serialize;

/// A resource for which a picture waits during a part of its latency.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Resource {
    /// Wait for the display's next retrace, or for its beam.
    Retrace,
    /// COPY: pixels are transferred into a port of a display.
    Ports,
    /// COPY: pixels wait for a channel of the ring.
    Ring,
    /// Renderers execute commands.
    Renderers,
    /// Renderers move a region to their backing store, or wait for room in the backing store.
    BackingStore,
    /// EDIT and TRANSFORM on the graphics processors.
    Transform,
    /// Messages and tokens between graphics processors and to renderers: time of the software and of the transfer.
    Messages,
    /// SEND on the host.
    Host,
    /// Time that the records do not explain.
    Other,
}

impl Resource {
    /// All resources, in the order from the screen back to the host.
    pub const ALL: [Self; 9] = [
        Self::Retrace,
        Self::Ports,
        Self::Ring,
        Self::Renderers,
        Self::BackingStore,
        Self::Transform,
        Self::Messages,
        Self::Host,
        Self::Other,
    ];

    /// Returns the name of the resource in reports and quantities.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Retrace => "retrace",
            Self::Ports => "ports",
            Self::Ring => "ring",
            Self::Renderers => "renderers",
            Self::BackingStore => "backing_store",
            Self::Transform => "transform",
            Self::Messages => "messages",
            Self::Host => "host",
            Self::Other => "other",
        }
    }

    /// Returns a description of the work for which a picture waits at this resource.
    pub const fn about(self) -> &'static str {
        match self {
            Self::Retrace => "the wait for the display's retrace",
            Self::Ports => "COPY through the displays' ports",
            Self::Ring => "the wait for a channel of the ring",
            Self::Renderers => "execution of commands in the renderers",
            Self::BackingStore => "moves to the renderers' backing store",
            Self::Transform => "EDIT and TRANSFORM on the graphics processors",
            Self::Messages => "messages and tokens of the graphics processors",
            Self::Host => "SEND on the host",
            Self::Other => "waits that no record explains",
        }
    }
}

pxpl5_sim::parameters::named!(Resource, "resource", Resource::ALL.map(|resource| (resource.name(), resource)));
