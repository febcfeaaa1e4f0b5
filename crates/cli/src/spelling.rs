//! Spelling of the names of arguments in messages and reports: the library writes a field of a request in backticks, `` `time_s` ``; the program
//! writes the flag, `--time`, a program that calls a verb its parameter, `` `time` ``.

use crate::console::Console;
use clap::{ArgMatches, Command};
use etendue::{Error, ImageTile, InputError, Message, Observer, Progress};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The spelling of every argument, by the name of its field.
pub(crate) struct Spelling(BTreeMap<String, String>);

impl Spelling {
    /// Spells arguments as flags of the command line.
    pub(crate) fn flags(command: &Command, matches: &ArgMatches) -> Self {
        Self::new(command, matches, &|flag| format!("--{flag}"))
    }

    /// Spells arguments as parameters of functions, in backticks.
    pub(crate) fn parameters(command: &Command, matches: &ArgMatches) -> Self {
        Self::new(command, matches, &|flag| format!("`{}`", flag.replace('-', "_")))
    }

    /// Creates the spelling. Arguments of the called verb take precedence over those of others.
    fn new(command: &Command, matches: &ArgMatches, written: &dyn Fn(&str) -> String) -> Self {
        let mut spelling = Self(BTreeMap::new());
        spelling.add_all(command, written);
        let (mut command, mut matches) = (command, matches);
        while let Some((name, of_verb)) = matches.subcommand() {
            let Some(verb) = command.find_subcommand(name) else { break };
            spelling.add(verb, written);
            (command, matches) = (verb, of_verb);
        }
        spelling
    }

    fn add_all(&mut self, command: &Command, written: &dyn Fn(&str) -> String) {
        self.add(command, written);
        command.get_subcommands().for_each(|verb| self.add_all(verb, written));
    }

    fn add(&mut self, command: &Command, written: &dyn Fn(&str) -> String) {
        for argument in command.get_arguments() {
            if let Some(flag) = argument.get_long() {
                self.0.insert(argument.get_id().to_string(), written(flag));
            }
        }
    }

    /// Returns a text with the names of arguments spelled.
    pub(crate) fn text<'a>(&self, text: &'a str) -> Cow<'a, str> {
        if !text.contains('`') {
            return Cow::Borrowed(text);
        }
        let mut spelled = String::with_capacity(text.len());
        let mut rest = text;
        while let Some(start) = rest.find('`') {
            let after = &rest[start + 1..];
            let name = after.split('`').next().filter(|name| name.len() < after.len());
            match name.and_then(|name| Some((name, self.0.get(name)?))) {
                Some((name, written)) => {
                    spelled.push_str(&rest[..start]);
                    spelled.push_str(written);
                    rest = &after[name.len() + 1..];
                }
                None => {
                    spelled.push_str(&rest[..=start]);
                    rest = after;
                }
            }
        }
        spelled.push_str(rest);
        Cow::Owned(spelled)
    }

    /// Returns an error with the names of arguments spelled; its fields are only the names.
    pub(crate) fn error(&self, error: Error) -> Error {
        let field = |field: String| match self.0.get(&field) {
            Some(written) => written.trim_matches('`').to_owned(),
            None => field,
        };
        let respelled = |original: InputError| InputError {
            message: self.text(&original.message).into_owned(),
            problem: self.text(&original.problem).into_owned(),
            remedy: original.remedy.map(|remedy| self.text(&remedy).into_owned()),
            field: original.field.map(field),
            ..original
        };
        match error {
            Error::Input(errors) => Error::Input(errors.into_iter().map(respelled).collect()),
            Error::Run(reason) => Error::Run(self.text(&reason).into_owned()),
        }
    }
}

/// A console that spells the names of arguments in its messages and in texts of the library.
pub(crate) struct SpelledConsole<'a> {
    pub(crate) console: &'a dyn Console,
    pub(crate) spelling: &'a Spelling,
}

impl Console for SpelledConsole<'_> {
    fn print(&self, text: &str) {
        self.console.print(text);
    }

    fn print_json(&self, document: &str) {
        self.console.print_json(document);
    }

    fn print_message(&self, line: &str) {
        self.console.print_message(line);
    }

    fn is_terminal(&self) -> bool {
        self.console.is_terminal()
    }

    fn spelled(&self, text: &str) -> String {
        self.spelling.text(text).into_owned()
    }

    fn observer(&self) -> &dyn Observer {
        self
    }
}

impl Observer for SpelledConsole<'_> {
    fn message(&self, message: Message<'_>) {
        let observer = self.console.observer();
        match message {
            Message::Note(text) => observer.message(Message::Note(&self.spelling.text(text))),
            Message::Warning(text) => observer.message(Message::Warning(&self.spelling.text(text))),
        }
    }

    fn progress(&self, progress: Progress<'_>) {
        self.console.observer().progress(progress);
    }

    fn wants_tiles(&self) -> bool {
        self.console.observer().wants_tiles()
    }

    fn tile(&self, tile: &ImageTile<'_>) {
        self.console.observer().tile(tile);
    }

    fn now_s(&self) -> Option<f64> {
        self.console.observer().now_s()
    }

    fn cancelled(&self) -> bool {
        self.console.observer().cancelled()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spelling(verb: &[&str], parameters: bool) -> Spelling {
        let mut command = crate::command();
        let matches = command.try_get_matches_from_mut([&["etendue"], verb].concat()).expect("arguments of the verb");
        match parameters {
            true => Spelling::parameters(&command, &matches),
            false => Spelling::flags(&command, &matches),
        }
    }

    const RENDER: [&str; 4] = ["render", "job.toml", "-o", "out"];

    #[test]
    fn a_field_is_a_flag_of_the_program_and_a_parameter_of_a_function() {
        let text = "`time_s` 3: give `time_s` 10 or samples with `spp`";
        assert_eq!(spelling(&RENDER, false).text(text), "--time 3: give --time 10 or samples with --spp");
        assert_eq!(spelling(&RENDER, true).text(text), "`time` 3: give `time` 10 or samples with `spp`");
        let error = spelling(&RENDER, true).error(Error::argument("time_s", text));
        let Error::Input(errors) = error else { panic!("{error}") };
        assert_eq!(errors[0].field.as_deref(), Some("time"));
    }

    #[test]
    fn the_verb_s_own_argument_goes_before_that_of_another() {
        let calibrate = ["calibrate", "a.png", "--pitch-mm", "10"];
        assert_eq!(spelling(&calibrate, false).text("`camera_keys`"), "--output");
        assert_eq!(
            spelling(&["measure", "focal", "a.png", "--pitch-mm", "10"], false).text("`camera_keys`"),
            "--camera-out"
        );
    }

    #[test]
    fn other_words_stay_in_backticks() {
        let text = "`newmtl` and ` alone, `overwrite";
        assert_eq!(spelling(&RENDER, false).text(text), text);
        assert_eq!(spelling(&RENDER, false).text("a `b `overwrite` c"), "a `b --overwrite c");
    }
}
