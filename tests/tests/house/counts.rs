//! Figures of the code base that may only fall, each with a limit: its value when it was last lowered.

use crate::circles::tokens::{self, Token};
use crate::texts;

/// A figure of the repository and its limit.
struct RepositoryFigure {
    name: &'static str,
    value: usize,
    limit: usize,
}

/// The files of crates, without those that only tests compile: paths and texts.
fn sources() -> Vec<(String, String)> {
    let is_source = |name: &str| {
        let file = name.rsplit('/').next().unwrap_or(name);
        name.starts_with("crates/")
            && name.contains("/src/")
            && !name.contains("/tests/")
            && !file.ends_with("tests.rs")
    };
    texts(&[".rs"]).into_iter().filter(|(name, _)| is_source(name)).collect()
}

/// The lines before the tests of a file that hold code.
fn code_lines(text: &str) -> Vec<&str> {
    let before_tests = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text);
    let is_code = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with("//");
    before_tests.lines().filter(is_code).collect()
}

/// Number of lines of `use` declarations.
fn use_lines(lines: &[&str]) -> usize {
    let mut count = 0;
    let mut is_within = false;
    for line in lines {
        let words = line.trim_start().trim_start_matches("pub ").trim_start_matches("pub(crate) ");
        is_within |= words.starts_with("use ");
        count += usize::from(is_within);
        is_within &= !line.trim_end().ends_with(';');
    }
    count
}

/// Number of functions with a parameter that is a tuple.
fn tuple_functions(tokens: &[Token]) -> usize {
    let starts = tokens.iter().enumerate().filter(|(_, token)| token.is("fn"));
    starts.filter(|(at, _)| has_tuple(parameters(&tokens[at + 1..]))).count()
}

/// The tokens between the parentheses of a function whose name begins `tokens`; none for a type such as `fn(A) -> B`.
fn parameters(tokens: &[Token]) -> &[Token] {
    if tokens.first().is_none_or(|name| name.word().is_none()) {
        return &[];
    }
    let mut generics = 0;
    let open = tokens.iter().enumerate().position(|(at, token)| {
        match token {
            Token::Mark('<') => generics += 1,
            Token::Mark('>') if !tokens[at - 1].is_mark('-') => generics -= 1,
            _ => {}
        }
        generics == 0 && token.is_mark('(')
    });
    let Some(open) = open else { return &[] };
    let mut depth = 0;
    let close = tokens[open..].iter().position(|token| {
        match token {
            Token::Mark('(' | '[' | '{') => depth += 1,
            Token::Mark(')' | ']' | '}') => depth -= 1,
            _ => {}
        }
        depth == 0
    });
    close.map_or(&[], |close| &tokens[open + 1..open + close])
}

/// Returns true if a parameter's pattern or type is a tuple, or a reference to one.
fn has_tuple(parameters: &[Token]) -> bool {
    let mut depth = 0;
    let mut begins = true;
    for (at, token) in parameters.iter().enumerate() {
        let is_other = |next: &Token| next.is_mark(')') || next.is("impl") || next.is("dyn");
        let is_tuple = token.is_mark('(') && !parameters.get(at + 1).is_some_and(is_other);
        if depth == 0 && begins && is_tuple {
            return true;
        }
        match token {
            Token::Mark('(' | '[' | '{' | '<') => depth += 1,
            Token::Mark('>') if parameters[at - 1].is_mark('-') => {}
            Token::Mark(')' | ']' | '}' | '>') => depth -= 1,
            _ => {}
        }
        let continues = token.is_mark('&') || token.is("mut");
        begins = depth == 0 && (token.is_mark(',') || token.is_mark(':') || begins && continues);
    }
    false
}

/// Asserts that every figure is within its limit.
#[track_caller]
fn check(counts: &[RepositoryFigure]) {
    let table: Vec<String> = counts.iter().map(|c| format!("{}: {} (at most {})", c.name, c.value, c.limit)).collect();
    assert!(counts.iter().all(|count| count.value <= count.limit), "{}", table.join("\n"));
}

#[test]
fn figures_of_the_code_base_do_not_rise() {
    const SHORT: usize = 40;
    let sources = sources();
    let lines: Vec<Vec<&str>> = sources.iter().map(|(_, text)| code_lines(text)).collect();
    let all: usize = lines.iter().map(Vec::len).sum();
    let short = lines.iter().filter(|lines| lines.len() < SHORT).count();
    let uses: usize = lines.iter().map(|lines| use_lines(lines)).sum();
    let tuples: usize = sources.iter().map(|(_, text)| tuple_functions(&tokens::read(text).0)).sum();
    let counts = [
        RepositoryFigure { name: "functions with a tuple parameter", value: tuples, limit: 10 },
        RepositoryFigure {
            name: "files of under 40 lines of code, ‰",
            value: 1000 * short / sources.len(),
            limit: 170,
        },
        RepositoryFigure { name: "lines of code that are `use`, ‰", value: 1000 * uses / all, limit: 54 },
    ];
    check(&counts);
}

/// Words of the pages, as `wc -w` counts them: all pages, and those of the book (docs without docs/evidence).
#[test]
fn pages_do_not_grow() {
    let pages = texts(&[".md"]);
    let words = |is_counted: &dyn Fn(&str) -> bool| {
        let counted = pages.iter().filter(|(name, _)| is_counted(name));
        counted.map(|(_, text)| text.split_ascii_whitespace().count()).sum::<usize>()
    };
    let counts = [
        RepositoryFigure { name: "words of all pages", value: words(&|_| true), limit: 115_000 },
        RepositoryFigure {
            name: "words of the book",
            value: words(&|name| name.starts_with("docs/") && !name.starts_with("docs/evidence/")),
            limit: 93_000,
        },
    ];
    check(&counts);
}

#[test]
fn tuple_parameters_are_found() {
    let count = |text: &str| tuple_functions(&tokens::read(text).0);
    assert_eq!(count("fn a((x, y): (f64, f64)) {}"), 1);
    assert_eq!(count("fn a<F: Fn(u8) -> u8>(&self, f: F, p: &(f64, Vec<u8>)) -> (u8, u8) {}"), 1);
    assert_eq!(count("fn a(f: impl Fn((u8, u8)) -> u8, x: [f64; 2], u: ()) -> (u8, u8) { g((1, 2)) }"), 0);
    assert_eq!(count("fn a(f: &(impl Fn(u8) -> u8 + Sync), g: &mut (dyn Fn() + Send)) {}"), 0);
    assert_eq!(count("type A = fn((u8, u8)); fn b(x: &mut Vec<(u8, u8)>, A { y, .. }: A) {}"), 0);
}
