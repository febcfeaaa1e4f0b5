//! `etendue explain`: meaning and remedy of an error code.

use crate::console::Console;
use clap::Args;
use etendue::{Error, ErrorCode, ExampleContext};

/// `etendue explain`
#[derive(Debug, Args)]
pub struct Explain {
    /// The code of an error, such as unknown-key, shown in brackets before its message [default: a list of all codes]
    #[arg(value_name = "CODE")]
    pub code: Option<String>,
}

impl Explain {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        let text = match &self.code {
            None => list(),
            Some(word) => explanation(code(word)?),
        };
        console.print(&console.spelled(&text));
        Ok(())
    }
}

fn code(word: &str) -> Result<ErrorCode, Error> {
    word.parse().map_err(|error| Error::argument("code", format!("{error}")).with_code(ErrorCode::UnknownName))
}

/// All codes with their causes, one per line.
fn list() -> String {
    let width = ErrorCode::ALL.iter().map(|code| code.word().len()).max().unwrap_or(0);
    let line = |code: &ErrorCode| format!("{:width$}  {}\n", code.word(), code.explanation().cause);
    ErrorCode::ALL.iter().map(line).collect()
}

fn explanation(code: ErrorCode) -> String {
    let explanation = code.explanation();
    let example = explanation.example;
    let (place, before) = match example.context {
        ExampleContext::Keys => ("keys of a description".to_owned(), ""),
        ExampleContext::File(name) => (format!("a line of {name}"), ""),
        ExampleContext::Command => ("a command".to_owned(), "etendue "),
    };
    let indented = |fragment: &str| -> String {
        let line = |line: &str| if line.is_empty() { "\n".to_owned() } else { format!("    {before}{line}\n") };
        fragment.lines().map(line).collect()
    };
    format!(
        "{code}: {}\n\nExample ({place}):\n{}\nwithout the error:\n{}\nWhat to do: {}\n",
        explanation.cause,
        indented(example.wrong),
        indented(example.right),
        explanation.remedy
    )
}
