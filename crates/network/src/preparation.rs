use serde::Deserialize;

/// Order of a network's three colour channels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ChannelOrder {
    /// Red first.
    #[default]
    Rgb,
    /// Blue first.
    Bgr,
}

/// Where a scaled image lies in a network's input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Padding {
    /// In the middle, its aspect ratio kept.
    #[default]
    Center,
    /// In the upper left corner, its aspect ratio kept.
    TopLeft,
    /// All over the input, its aspect ratio lost.
    Stretch,
}

/// How pixels become the numbers that a network was trained on.
///
/// A channel's value, 0 to 255, becomes `(value * scale - mean) / std`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Preparation {
    /// Order of the channels.
    pub channels: ChannelOrder,
    /// What each value is multiplied by first: 1/255 for networks that take 0 to 1, 1 for those that take 0 to 255.
    pub scale: f32,
    /// What is subtracted from each scaled channel, in the network's order.
    pub mean: [f32; 3],
    /// What each channel is divided by, in the network's order.
    pub std: [f32; 3],
    /// Where the image lies.
    pub padding: Padding,
    /// Grey value, 0 to 255, of what the image does not cover.
    pub fill: u8,
}

impl Preparation {
    /// The scale of networks that take values from 0 to 1.
    pub const UNIT_SCALE: f32 = 1.0 / 255.0;
}

impl Default for Preparation {
    /// RGB from 0 to 1, centred on the grey of Ultralytics' networks.
    fn default() -> Self {
        Self {
            channels: ChannelOrder::Rgb,
            scale: Self::UNIT_SCALE,
            mean: [0.0; 3],
            std: [1.0; 3],
            padding: Padding::Center,
            fill: 114,
        }
    }
}
