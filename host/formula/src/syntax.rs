//! The grammar of a law.
//!
//! ```text
//! law        = name ":" statement (";" statement)*
//! statement  = place "=" expression
//!            | state "'" "=" expression
//!            | names ["=" number] "in" "[" number "," number "]" [unit]
//!            | name "=" number [unit]
//! place      = "torque" | "friction" | "voltage" | "current" | "torque_constant" | "angle" | "inertia"
//! expression = sums and products of numbers, names, functions; "^" binds tightest and to the right
//! ```

use crate::fault::Fault;
use shared::effects::formula::{Output, Variable};
use winnow::LocatingSlice;
use winnow::ascii::{float, multispace0};
use winnow::combinator::{
    Infix, Prefix, alt, cut_err, delimited, dispatch, empty, eof, expression, fail, opt, preceded,
    repeat, separated, terminated,
};
use winnow::error::{ContextError, ErrMode, StrContext, StrContextValue};
use winnow::prelude::*;
use winnow::stream::Location;
use winnow::token::{any, take_while};

/// Longest text of a law, bytes.
const LONGEST: usize = 4000;
/// Deepest nesting.
const DEEPEST: usize = 40;

/// An expression and where it begins in the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    /// What it is.
    pub term: Term,
    /// Where it begins, bytes.
    pub at: usize,
}

/// What an expression is.
#[derive(Clone, Debug, PartialEq)]
pub enum Term {
    /// A number.
    Number(f64),
    /// A variable.
    Variable(Variable),
    /// The state at this place.
    State(usize),
    /// The parameter at this place.
    Parameter(usize),
    /// The fixed number at this place.
    Fixed(usize),
    /// A name that is not known yet.
    Name(String),
    /// With the other sign.
    Negative(Box<Expression>),
    /// A function of one or two arguments.
    Call(Function, Vec<Expression>),
    /// Two expressions joined.
    Binary(Binary, Box<Expression>, Box<Expression>),
}

/// How two expressions are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binary {
    /// Sum.
    Add,
    /// Difference.
    Sub,
    /// Product.
    Mul,
    /// Quotient.
    Div,
    /// Power.
    Power,
}

/// A function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// Magnitude.
    Abs,
    /// Sign.
    Sign,
    /// The smaller of two.
    Min,
    /// The larger of two.
    Max,
    /// Natural exponential.
    Exp,
    /// Square root.
    Sqrt,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Hyperbolic tangent.
    Tanh,
}

/// Functions by name.
pub(crate) const FUNCTIONS: [(&str, Function); 9] = [
    ("abs", Function::Abs),
    ("sgn", Function::Sign),
    ("min", Function::Min),
    ("max", Function::Max),
    ("exp", Function::Exp),
    ("sqrt", Function::Sqrt),
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tanh", Function::Tanh),
];

impl Function {
    /// How many arguments it takes.
    pub fn arguments(self) -> usize {
        match self {
            Function::Min | Function::Max => 2,
            _ => 1,
        }
    }
}

/// Variables by name.
pub(crate) const VARIABLES: [(&str, Variable); 8] = [
    ("w", Variable::Speed),
    ("theta", Variable::Angle),
    ("i", Variable::Current),
    ("tau", Variable::Transmitted),
    ("u", Variable::Command),
    ("v", Variable::Command),
    ("t", Variable::Time),
    ("temperature", Variable::Temperature),
];

/// Variables whose names laws had for numbers of their own before: such a law means its own.
pub(crate) const MAY_BE_NAMED: [&str; 2] = ["v", "temperature"];

/// Places by name. A current beside the winding's makes torque, and both are in V at the winding: it is a torque.
pub(crate) const PLACES: [(&str, Output); 7] = [
    ("torque", Output::Torque),
    ("current", Output::Torque),
    ("friction", Output::Friction),
    ("voltage", Output::Voltage),
    ("torque_constant", Output::TorqueConstant),
    ("angle", Output::Angle),
    ("inertia", Output::Inertia),
];

/// What is said where a name that is no place has a law.
const NO_PLACE: &str = "a number, as laws belong to torque, friction, voltage, current, torque_constant, angle or inertia";

pub(crate) fn found<T: Copy>(list: &[(&str, T)], name: &str) -> Option<T> {
    let mut list = list.iter();
    list.find(|(own, _)| *own == name).map(|(_, value)| *value)
}

type Input<'a> = LocatingSlice<&'a str>;
type Parsed<T> = ModalResult<T, ContextError>;

fn expected(what: &'static str) -> StrContext {
    StrContext::Expected(StrContextValue::Description(what))
}

fn token<'a>(word: &'static str) -> impl Parser<Input<'a>, &'a str, ErrMode<ContextError>> {
    terminated(word, multispace0)
}

fn identifier<'a>(input: &mut Input<'a>) -> Parsed<&'a str> {
    let letters = (
        take_while(1, |c: char| c.is_ascii_alphabetic()),
        take_while(0.., |c: char| c.is_ascii_alphanumeric() || c == '_'),
    );
    terminated(letters.take(), multispace0)
        .context(expected("a name"))
        .parse_next(input)
}

fn unsigned(input: &mut Input<'_>) -> Parsed<f64> {
    // Words such as `inf` are names.
    let begins = |c: char| c.is_ascii_digit() || c == '.';
    if !input.as_ref().starts_with(begins) {
        return fail.context(expected("a number")).parse_next(input);
    }
    terminated(float, multispace0)
        .verify(|x: &f64| x.is_finite())
        .context(expected("a number"))
        .parse_next(input)
}

fn number(input: &mut Input<'_>) -> Parsed<f64> {
    let sign = opt(token("-")).parse_next(input)?;
    let size = unsigned(input)?;
    Ok(if sign.is_some() { -size } else { size })
}

fn operand(input: &mut Input<'_>) -> Parsed<Expression> {
    let at = input.current_token_start();
    if input.as_ref().starts_with('-') {
        return fail.parse_next(input);
    }
    // Anything else that is no operand is wrong here.
    let term = cut_err(alt((
        unsigned.map(Term::Number),
        delimited(
            token("("),
            sum,
            cut_err(token(")")).context(expected("`)`")),
        )
        .map(|inner| inner.term),
        named,
    )))
    .context(expected("a number, a name or `(`"))
    .parse_next(input)?;
    Ok(Expression { term, at })
}

/// A name, or a function with its arguments.
fn named(input: &mut Input<'_>) -> Parsed<Term> {
    let name = identifier(input)?;
    let Some(function) = found(&FUNCTIONS, name) else {
        return Ok(Term::Name(name.to_owned()));
    };
    let arguments = delimited(
        token("(").context(expected("`(`")),
        separated(1..=2, sum, token(",")),
        token(")").context(expected("`)`")),
    );
    let arguments: Vec<Expression> = cut_err(arguments).parse_next(input)?;
    if arguments.len() != function.arguments() {
        let needed = match function.arguments() {
            1 => "one argument",
            _ => "two arguments",
        };
        return cut_err(fail.context(expected(needed))).parse_next(input);
    }
    Ok(Term::Call(function, arguments))
}

fn sum(input: &mut Input<'_>) -> Parsed<Expression> {
    let infix = |input: &mut Input<'_>| -> Parsed<Infix<_, Expression, ErrMode<ContextError>>> {
        terminated(
            dispatch! {any;
                '+' => empty.value(Infix::Left(5, |_, a, b| Ok(join(Binary::Add, a, b)))),
                '-' => empty.value(Infix::Left(5, |_, a, b| Ok(join(Binary::Sub, a, b)))),
                '*' => empty.value(Infix::Left(7, |_, a, b| Ok(join(Binary::Mul, a, b)))),
                '/' => empty.value(Infix::Left(7, |_, a, b| Ok(join(Binary::Div, a, b)))),
                '^' => empty.value(Infix::Right(11, |_, a, b| Ok(join(Binary::Power, a, b)))),
                _ => fail,
            },
            multispace0,
        )
        .parse_next(input)
    };
    let prefix = |input: &mut Input<'_>| -> Parsed<Prefix<_, Expression, ErrMode<ContextError>>> {
        terminated(
            '-'.value(Prefix(9, |_: &mut Input<'_>, a: Expression| {
                let at = a.at;
                let term = Term::Negative(Box::new(a));
                Ok(Expression { term, at })
            })),
            multispace0,
        )
        .parse_next(input)
    };
    expression(operand)
        .prefix(prefix)
        .infix(infix)
        .parse_next(input)
}

fn join(binary: Binary, a: Expression, b: Expression) -> Expression {
    Expression {
        at: a.at,
        term: Term::Binary(binary, Box::new(a), Box::new(b)),
    }
}

/// A statement as it stands, with places in the text.
pub(crate) enum Statement {
    Place(usize, Output, Expression),
    Rate(usize, String, Expression),
    Range {
        names: Vec<(usize, String)>,
        start: Option<f64>,
        range: (f64, f64),
        unit: (usize, String),
    },
    Fixed(usize, String, f64, (usize, String)),
}

fn unit(input: &mut Input<'_>) -> Parsed<(usize, String)> {
    let at = input.current_token_start();
    let text = take_while(0.., |c: char| c != ';').parse_next(input)?;
    Ok((at, text.trim().to_owned()))
}

fn place(input: &mut Input<'_>) -> Parsed<Statement> {
    let at = input.current_token_start();
    let output = identifier
        .verify_map(|name| found(&PLACES, name))
        .parse_next(input)?;
    let law = cut_err(preceded(token("=").context(expected("`=`")), sum)).parse_next(input)?;
    Ok(Statement::Place(at, output, law))
}

fn rate(input: &mut Input<'_>) -> Parsed<Statement> {
    let at = input.current_token_start();
    let name = terminated(identifier, token("'"))
        .parse_next(input)?
        .to_owned();
    let rate = cut_err(preceded(token("=").context(expected("`=`")), sum)).parse_next(input)?;
    Ok(Statement::Rate(at, name, rate))
}

/// What a parameter is equal to. Whoever writes more there looks for a place that there is not.
fn value(input: &mut Input<'_>) -> Parsed<f64> {
    let begins = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
    if !input.as_ref().starts_with(begins) {
        return fail.context(expected(NO_PLACE)).parse_next(input);
    }
    number(input)
}

fn parameter(input: &mut Input<'_>) -> Parsed<Statement> {
    let own = |input: &mut Input<'_>| -> Parsed<(usize, String)> {
        let at = input.current_token_start();
        Ok((at, identifier(input)?.to_owned()))
    };
    let names: Vec<(usize, String)> = separated(1.., own, token(",")).parse_next(input)?;
    let start = opt(preceded(token("="), cut_err(value))).parse_next(input)?;
    let within = opt(token("in")).parse_next(input)?;
    match (within, start, names.as_slice()) {
        (Some(_), ..) => {
            let bounds = (
                preceded(token("[").context(expected("`[`")), number),
                preceded(token(",").context(expected("`,`")), number),
                token("]").context(expected("`]`")),
            );
            let (low, high, _) = cut_err(bounds).parse_next(input)?;
            let unit = unit(input)?;
            Ok(Statement::Range {
                names,
                start,
                range: (low, high),
                unit,
            })
        }
        (None, Some(value), [(at, name)]) => {
            Ok(Statement::Fixed(*at, name.clone(), value, unit(input)?))
        }
        _ => cut_err(fail.context(expected("`in [low, high]` or `=`"))).parse_next(input),
    }
}

fn law(input: &mut Input<'_>) -> Parsed<(String, Vec<Statement>)> {
    multispace0.parse_next(input)?;
    let name = cut_err(identifier).parse_next(input)?.to_owned();
    cut_err(token(":").context(expected("`:` after the name"))).parse_next(input)?;
    let statement = alt((place, rate, parameter)).context(expected(
        "a place such as `torque = ...`, a state `z' = ...` or a parameter `c in [0, 1] V`",
    ));
    let between = repeat::<_, _, (), _, _>(1.., token(";"));
    let statements = separated(1.., cut_err(statement), between).parse_next(input)?;
    opt(token(";")).parse_next(input)?;
    cut_err(eof.context(expected("`;`, an operator or the end"))).parse_next(input)?;
    Ok((name, statements))
}

/// Reads a law's name and its statements.
///
/// # Errors
/// Text that is no law, with the place and what was expected there.
pub(crate) fn statements(text: &str) -> Result<(String, Vec<Statement>), Fault> {
    if text.len() > LONGEST {
        let what = format!("the law is longer than {LONGEST} characters");
        return Err(Fault::new(text, LONGEST, what));
    }
    nesting(text)?;
    law.parse(LocatingSlice::new(text)).map_err(|error| {
        let at = error.offset();
        let expected: Vec<String> = (error.inner().context())
            .filter_map(|context| match context {
                StrContext::Expected(what) => Some(what.to_string()),
                _ => None,
            })
            .collect();
        let found = text.get(at..).and_then(|rest| rest.chars().next());
        let found = found.map_or("the end".to_owned(), |c| format!("`{c}`"));
        let expected = expected.first().map_or("something else", |first| first);
        Fault::new(text, at, format!("expected {expected}, found {found}"))
    })
}

/// Refuses what is nested too deeply to be read.
fn nesting(text: &str) -> Result<(), Fault> {
    let (mut depth, mut signs) = (0usize, 0usize);
    for (at, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            '-' | '^' => signs += 1,
            ';' => signs = 0,
            _ => {}
        }
        if depth > DEEPEST || signs > 4 * DEEPEST {
            let what = format!("the law is nested more than {DEEPEST} deep");
            return Err(Fault::new(text, at, what));
        }
    }
    Ok(())
}
