//! Clouds, images and frames that other programs and cameras wrote.

mod foreign;
mod orchard;
