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
use anyhow::bail;
pub(crate) use arguments::PickArguments;
pub(crate) use files::PICKS;

use jobs::{Job, jobs};
use pomona::record::PicksRecord;
use pomona::{FrameAnswer, RobotFromCamera};
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
