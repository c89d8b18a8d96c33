use super::files::FileChoice;
use crate::apple_cloud::CloudChoice;
use crate::detector::DetectorArguments;
use crate::frame_arguments::FrameArguments;
use crate::settings::SettingsArguments;
use crate::wood::{SegmenterChoice, parse_segmenter};
use clap::Args;
use pomona_cloud::Frame;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "\
Examples:
  pomona pick frames/a --out out                      out/picks.json, picture.png, apple-N.ply
  pomona pick frames/a frames/b --out out             out/a/... and out/b/...
  pomona pick frames/a --boxes detections.json --out out
  pomona pick frames/a --segmenter built-in --out out branches by colour and depth, for real trees
  pomona pick frames/a --wood a.wood.png --out out    branches by somebody else's mask of wood
  pomona pick frames/a --detect --model mine.onnx --out out
  pomona pick frames/a --transform robot_from_camera.json --out out
  pomona pick frames/a --transform robot_from_camera.json --robot robot.toml --ros --out out
  pomona pick frames/a --radius-max-mm 60 --set paper.shell_outer=2.5 --out out
  pomona pick frames/left frames/right --fuse --out out    out/fused.json beside out/left and out/right
  pomona pick frames/* --out out --json | jq '.[].picks[].direction'

The camera's pose is robot_from_camera.json in the frame's folder, else that of --transform: of a fixed camera, or of one \
on the gripper where the folder has base_from_flange.json. With --fuse, the frames show one tree.

A frame is a folder with color.png (or .jpg), depth.png (16 bit, registered to colour), camera.json (or a camera \
file of ROS, OpenCV, Kalibr, Open3D or RealSense) and, optionally, boxes (boxes.xml VOC, boxes.json COCO or boxes.txt YOLO). Without boxes the detector finds the apples, and \
the depth check marks false ones: see `detection` in `pomona config`.

In the table, `angle` is the angle of the direction in the image (0 right, 90 up) and `away` its angle out of the \
image plane (positive away from the camera).

An apple that cannot be answered is refused with a reason, and the run continues. Exit code 0: every frame was \
processed. 2: bad input; nothing is written for frames that failed.";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
#[allow(
    clippy::struct_excessive_bools,
    reason = "each is a flag of the command line"
)]
pub(crate) struct PickArguments {
    /// Folders of frames.
    #[arg(required = true, value_name = "FRAME")]
    pub(super) frames: Vec<PathBuf>,
    /// Output folder; several frames get a folder each in it. Files of earlier runs are replaced.
    #[arg(short, long, value_name = "DIR")]
    pub(super) out: PathBuf,
    /// Boxes of the apples (VOC, COCO, YOLO, CVAT, `LabelMe`, Label Studio, or what `pomona detect` wrote) instead of
    /// the frame's own; for one frame.
    #[arg(long, value_name = "FILE")]
    pub(super) boxes: Option<PathBuf>,
    /// Where wood is: an 8-bit grey image of the colour image's size, 255 where it is sure of wood, such as
    /// NAME.wood.png of `pomona segment`; for one frame.
    #[arg(long, value_name = "FILE")]
    pub(super) wood: Option<PathBuf>,
    /// The segmentation model that tells wood in the colour image (ONNX), `built-in`, or `none`: branches are then
    /// looked for in depth alone. For real trees; --runtime holds for it too.
    #[arg(long, value_name = "FILE", default_value = "none", value_parser = parse_segmenter, conflicts_with = "wood")]
    pub(super) segmenter: SegmenterChoice,
    /// Run the detector even if a frame has boxes.
    #[arg(long, conflicts_with = "boxes")]
    pub(super) detect: bool,
    /// Seed of the random numbers.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(super) seed: u64,
    /// Transform from the camera frame to the robot frame, in a form that `pomona inspect` knows; adds the answers in the
    /// robot frame. With the camera on the gripper: `flange_from_camera` of `pomona calibrate --kind eye-in-hand`, and in
    /// each frame's folder the flange's pose at the shot, `base_from_flange.json`.
    #[arg(long, value_name = "FILE")]
    pub(super) transform: Option<PathBuf>,
    /// Plan paths and picking order for a robot with these settings (see `pomona config --robot`); adds gripper,
    /// approach, clearance and order to the record, and the paths to the picture.
    #[arg(long, value_name = "FILE")]
    pub(super) robot: Option<PathBuf>,
    /// Also write the plan as ROS 2 and `MoveIt` messages, ros-*.yaml for `ros2 topic pub`.
    #[arg(long, requires = "robot")]
    pub(super) ros: bool,
    /// Also write frame and plan as recording.mcap, for Foxglove.
    #[cfg(feature = "mcap")]
    #[arg(long, requires = "robot")]
    pub(super) mcap: bool,
    /// Combine frames of one tree in the robot frame: one answer for each apple, the sway of the tree, and which
    /// apples moved; written to fused.json.
    #[arg(long)]
    pub(super) fuse: bool,
    /// Also write the points of all frames in the robot frame to fused.ply, thinned to `fusion.voxel_m`.
    #[arg(long, requires = "fuse")]
    pub(super) fused_cloud: bool,
    /// Print the record to standard output instead of the table: one JSON object for one frame, an array for several;
    /// the fused record with --fuse.
    #[arg(long)]
    pub(super) json: bool,
    /// Do not write picture.png.
    #[arg(long)]
    pub(super) no_picture: bool,
    /// Which apples get a coloured cloud apple-N.ply: best (the picked apple with the most surface points), all,
    /// none, or numbers such as 0,3.
    #[arg(long, value_name = "WHICH", default_value = "best")]
    pub(super) clouds: CloudChoice,
    #[command(flatten)]
    pub(super) frame: FrameArguments,
    #[command(flatten)]
    pub(super) detector: DetectorArguments,
    #[command(flatten)]
    pub(super) settings: SettingsArguments,
}

impl PickArguments {
    /// An option whose file belongs to one frame, where there is one.
    pub(super) fn of_one_frame(&self) -> Option<&'static str> {
        let boxes = self.boxes.is_some().then_some("--boxes");
        boxes.or(self.wood.is_some().then_some("--wood"))
    }

    /// Whether the apples of a frame are boxed in a file, so that no detector runs.
    pub(super) fn has_boxes(&self, frame: &Path) -> bool {
        !self.detect && (self.boxes.is_some() || Frame::box_file(frame).is_some())
    }

    /// Which files a frame's answers are written to.
    pub(super) fn files(&self) -> FileChoice<'_> {
        FileChoice {
            picture: !self.no_picture,
            clouds: &self.clouds,
            ros: self.ros,
            #[cfg(feature = "mcap")]
            recording: self.mcap,
        }
    }
}
