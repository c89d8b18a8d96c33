use crate::terminal;
use clap::{Args, Command};
use clap_complete::Shell;

const EXAMPLES: &str = "\
Examples:
  pomona completions bash > ~/.local/share/bash-completion/completions/pomona
  pomona completions zsh > ~/.zfunc/_pomona
  pomona completions fish > ~/.config/fish/completions/pomona.fish";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct CompletionsArguments {
    /// The shell.
    shell: Shell,
}

/// Prints the completions of `command`, the whole command line.
pub(crate) fn run(arguments: &CompletionsArguments, mut command: Command) -> anyhow::Result<()> {
    // Into memory first: the generator panics where its writer fails.
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, "pomona", &mut script);
    terminal::print(&String::from_utf8_lossy(&script))
}
