//! `pomona pick`: frames in, answers out.

mod arguments;
mod files;
mod jobs;
mod session;

use crate::fuse;
use crate::output_folder::OutputFolder;
use crate::progress;
use crate::summary::{Summary, plural};
use crate::table::table;
use crate::terminal::{self, Terminal};
use crate::wood::SegmenterChoice;
use anyhow::bail;
pub(crate) use arguments::PickArguments;
pub(crate) use files::PICKS;

use jobs::{Job, jobs};
use pomona::record::PicksRecord;
use pomona::{FrameAnswer, RobotFromCamera, Status};
use session::Session;

/// Reads the arguments, answers the frames, fuses them where that is asked for, and prints what came of it.
pub(crate) fn run(arguments: &PickArguments, terminal: Terminal) -> anyhow::Result<()> {
    let config = arguments.settings.config()?;
    log::debug!("{config:?}");
    let session = Session::new(arguments, config)?;
    let fused_output = arguments
        .fuse
        .then(|| fuse::claim(&arguments.frames, &arguments.out))
        .transpose()?;
    let jobs = jobs(&arguments.frames, &arguments.out, arguments.of_one_frame())?;
    check_detector_options(arguments, &jobs, terminal)?;
    if arguments.fuse {
        fuse::check_poses(
            session.poses(),
            &jobs.iter().map(|job| &*job.frame).collect::<Vec<_>>(),
        )?;
    }

    let (answers, poses) = answer_all(arguments, &session, &jobs, terminal)?;
    let failed = jobs.len() - answers.len();
    if let (Some(output), 0) = (&fused_output, failed) {
        fuse_all(
            arguments, &session, &jobs, &poses, &answers, output, terminal,
        )?;
    }
    // What stands there of an earlier run would be taken for an answer of this one.
    if !arguments.fuse || failed > 0 {
        fuse::remove_earlier(&arguments.out)?;
    }
    if jobs.len() > 1 {
        files::remove_earlier(&arguments.out)?;
    }
    print_result(arguments, &answers)?;
    if failed > 0 {
        let consequence = if arguments.fuse {
            ", and nothing was fused,"
        } else {
            ""
        };
        bail!(
            "{failed} of {}{consequence} failed, for the reasons above",
            plural(jobs.len(), "frame"),
        );
    }
    Ok(())
}

/// Refuses options of the detector where every frame has boxes, and says for which frames they mean nothing.
fn check_detector_options(
    arguments: &PickArguments,
    jobs: &[Job],
    terminal: Terminal,
) -> anyhow::Result<()> {
    let segmenter_runs = arguments.segmenter != SegmenterChoice::None;
    let Some(option) = arguments.detector.of_detector_alone(segmenter_runs) else {
        return Ok(());
    };
    let with_boxes: Vec<&Job> = jobs
        .iter()
        .filter(|job| arguments.has_boxes(&job.frame))
        .collect();
    if with_boxes.len() == jobs.len() {
        bail!(
            "{option} is for the detector, which does not run where boxes are given; leave {option} out, or add \
             --detect and no --boxes to detect the apples"
        );
    }
    for job in with_boxes {
        terminal.note(&format!(
            "{}: its own boxes are taken, without {option}; --detect runs the detector for it too",
            job.frame.display()
        ));
    }
    Ok(())
}

/// Answers the frames one after the other, writes their files and prints their tables; the answers, and the poses of
/// their cameras. A frame that fails is reported and left out, unless it is the only one.
fn answer_all(
    arguments: &PickArguments,
    session: &Session<'_>,
    jobs: &[Job],
    terminal: Terminal,
) -> anyhow::Result<(Vec<FrameAnswer>, Vec<Option<RobotFromCamera>>)> {
    let bar = progress::bar(jobs.len());
    let (mut answers, mut poses) = (Vec::new(), Vec::new());
    for job in jobs {
        bar.set_message(job.frame.display().to_string());
        match session.run(job, terminal) {
            Ok((answer, pose)) => {
                for warning in &answer.warnings {
                    bar.suspend(|| terminal.warn(&answer.id, warning));
                }
                if let Some(note) = empty_boxes(&answer) {
                    bar.suspend(|| terminal.note(&note));
                }
                if !arguments.json {
                    let separator = if answers.is_empty() { "" } else { "\n" };
                    let text = separator.to_owned() + &table(&answer, terminal);
                    bar.suspend(|| terminal::print(&text))?;
                }
                answers.push(answer.without_evidence());
                poses.push(pose);
            }
            Err(error) if jobs.len() == 1 => return Err(error),
            Err(error) => bar.suspend(|| terminal.error(&error)),
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok((answers, poses))
}

/// What to do about boxes that hold no apple, where there are any.
fn empty_boxes(answer: &FrameAnswer) -> Option<String> {
    // A detector's boxes are nobody's to take.
    if answer.detection.is_some() {
        return None;
    }
    let empty = answer.apples.iter().filter(|a| a.status == Status::NoApple);
    let count = empty.count();
    let boxes = match count {
        0 => return None,
        1 => "1 box is".to_owned(),
        _ => format!("{count} boxes are"),
    };
    Some(format!(
        "{}: {boxes} refused as `no_apple`, since depth and colour show no apple there; where a person has drawn the \
         boxes, `--set robust.check_boxes=false` takes them as they are",
        answer.id
    ))
}

/// Fuses the answers of all frames; each has a pose.
fn fuse_all(
    arguments: &PickArguments,
    session: &Session<'_>,
    jobs: &[Job],
    poses: &[Option<RobotFromCamera>],
    answers: &[FrameAnswer],
    output: &OutputFolder,
    terminal: Terminal,
) -> anyhow::Result<()> {
    let frames = jobs.iter().zip(answers).zip(poses.iter().flatten());
    let frames: Vec<_> = frames
        .map(|((job, answer), pose)| fuse::FusedInput {
            folder: &job.frame,
            answer,
            pose,
        })
        .collect();
    let task = fuse::Task {
        frames: &frames,
        output,
        read: arguments.frame,
        cloud: arguments.fused_cloud,
        json: arguments.json,
    };
    task.run(&session.config().fusion, terminal)
}

/// Prints the records, or what a person wants to know at the end.
fn print_result(arguments: &PickArguments, answers: &[FrameAnswer]) -> anyhow::Result<()> {
    if arguments.json {
        // With --fuse the fused record has been printed, where there is one.
        if !arguments.fuse {
            terminal::print(&(json(answers, arguments.frames.len() == 1)? + "\n"))?;
        }
    } else if !answers.is_empty() {
        let (summary, place) = (Summary::of(answers), arguments.out.display());
        terminal::print(&format!("\n{summary}; written to {place}\n"))?;
    }
    Ok(())
}

fn json(answers: &[FrameAnswer], one: bool) -> serde_json::Result<String> {
    let records: Vec<PicksRecord> = answers.iter().map(PicksRecord::from).collect();
    match &*records {
        [record] if one => serde_json::to_string_pretty(record),
        records => serde_json::to_string_pretty(records),
    }
}
