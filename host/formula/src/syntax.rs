//! The grammar of a law.
//!
//! ```text
//! law        = name ":" statement (";" statement)*
//! statement  = place "=" expression
//!            | state "'" "=" expression
//!            | names ["=" number] "in" "[" number "," number "]" [unit]
//!            | name "=" number [unit]
//! place      = "torque" | "friction" | "voltage" | "torque_constant" | "angle"
//! expression = sums and products of numbers, names, functions; "^" binds tightest and to the right
//! ```

use crate::dimension::{self, Dimension};
use crate::fault::Fault;
use shared::effects::MAX_PARAMETERS;
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
    /// The state.
    State,
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
pub(crate) const VARIABLES: [(&str, Variable); 6] = [
    ("w", Variable::Speed),
    ("theta", Variable::Angle),
    ("i", Variable::Current),
    ("tau", Variable::Transmitted),
    ("u", Variable::Command),
    ("t", Variable::Time),
];

/// Places by name.
pub(crate) const PLACES: [(&str, Output); 6] = [
    ("torque", Output::Torque),
    ("friction", Output::Friction),
    ("voltage", Output::Voltage),
    ("torque_constant", Output::TorqueConstant),
    ("angle", Output::Angle),
    ("inertia", Output::Inertia),
];

fn found<T: Copy>(list: &[(&str, T)], name: &str) -> Option<T> {
    let mut list = list.iter();
    list.find(|(own, _)| *own == name).map(|(_, value)| *value)
}

/// A parameter of a law.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Value from which a search starts, and with which a simulation runs.
    pub start: f64,
    /// Range of the search.
    pub range: (f64, f64),
    /// Its unit, as it was written.
    pub unit: String,
    /// The same.
    pub dimension: Dimension,
}

/// A number with a unit and a name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fixed {
    pub(crate) name: String,
    pub(crate) value: f64,
    pub(crate) unit: String,
    pub(crate) dimension: Dimension,
}

/// A law as it was stated.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition {
    /// Its name.
    pub name: String,
    /// What it gives.
    pub output: Output,
    /// How that depends on the motion.
    pub law: Expression,
    /// Name of the state, its rate by the second, and its range.
    pub state: Option<(String, Expression, (f64, f64))>,
    /// Parameters in the order in which they were stated.
    pub parameters: Vec<Parameter>,
    pub(crate) fixed: Vec<Fixed>,
    pub(crate) text: String,
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

/// A statement as it stands.
enum Statement {
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

fn parameter(input: &mut Input<'_>) -> Parsed<Statement> {
    let own = |input: &mut Input<'_>| -> Parsed<(usize, String)> {
        let at = input.current_token_start();
        Ok((at, identifier(input)?.to_owned()))
    };
    let names: Vec<(usize, String)> = separated(1.., own, token(",")).parse_next(input)?;
    let start = opt(preceded(token("="), cut_err(number))).parse_next(input)?;
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

impl Definition {
    /// Reads a law.
    ///
    /// # Errors
    /// Text that is no law, with the place and what was expected there.
    pub fn parse(text: &str) -> Result<Self, Fault> {
        let fault = |at: usize, what: String| Fault::new(text, at, what);
        if text.len() > LONGEST {
            return Err(fault(
                LONGEST,
                format!("the law is longer than {LONGEST} characters"),
            ));
        }
        nesting(text)?;
        let (name, statements) = law.parse(LocatingSlice::new(text)).map_err(|error| {
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
        })?;
        let mut definition = Definition {
            name,
            output: Output::Torque,
            law: Expression {
                term: Term::Number(0.0),
                at: 0,
            },
            state: None,
            parameters: Vec::new(),
            fixed: Vec::new(),
            text: text.trim().to_owned(),
        };
        definition.take(text, statements)?;
        definition.resolve(text)?;
        dimension::check(&definition).map_err(|(at, what)| fault(at, what))?;
        Ok(definition)
    }

    fn take(&mut self, text: &str, statements: Vec<Statement>) -> Result<(), Fault> {
        let mut output = None;
        let mut ranges = Vec::new();
        for statement in statements {
            match statement {
                Statement::Place(at, place, law) => {
                    if output.is_some() {
                        let what = "a law has one place; state the other one as a law of its own";
                        return Err(Fault::new(text, at, what));
                    }
                    output = Some(place);
                    self.law = law;
                }
                Statement::Rate(at, name, rate) => {
                    if self.state.is_some() {
                        return Err(Fault::new(text, at, "a law has one state"));
                    }
                    self.state = Some((name, rate, (-1.0, 1.0)));
                }
                Statement::Fixed(at, name, value, (unit_at, unit)) => {
                    self.new_name(text, at, &name)?;
                    let dimension =
                        Dimension::parse(&unit).map_err(|what| Fault::new(text, unit_at, what))?;
                    self.fixed.push(Fixed {
                        name,
                        value,
                        unit,
                        dimension,
                    });
                }
                Statement::Range {
                    names,
                    start,
                    range,
                    unit,
                } => ranges.push((names, start, range, unit)),
            }
        }
        self.output = output.ok_or_else(|| {
            let places: Vec<&str> = PLACES.iter().map(|(name, _)| *name).collect();
            let what = format!(
                "the law has no place; add one of {} = ...",
                places.join(", ")
            );
            Fault::new(text, text.len(), what)
        })?;
        for (names, start, range, (unit_at, unit)) in ranges {
            for (at, name) in names {
                let (low, high) = range;
                if low >= high {
                    let what = format!("the range of {name} is empty: [{low}, {high}]");
                    return Err(Fault::new(text, at, what));
                }
                if let Some(start) = start.filter(|x| !(low..=high).contains(x)) {
                    let what = format!("{name} = {start} is outside of its range [{low}, {high}]");
                    return Err(Fault::new(text, at, what));
                }
                if let Some((state, _, range)) = &mut self.state
                    && *state == name
                {
                    *range = (low, high);
                    continue;
                }
                self.new_name(text, at, &name)?;
                let dimension =
                    Dimension::parse(&unit).map_err(|what| Fault::new(text, unit_at, what))?;
                self.parameters.push(Parameter {
                    name,
                    start: start.unwrap_or_else(|| middle(low, high)),
                    range,
                    unit: if unit.is_empty() {
                        "1".to_owned()
                    } else {
                        unit.clone()
                    },
                    dimension,
                });
            }
        }
        if self.parameters.len() > MAX_PARAMETERS {
            let what = format!("a law has at most {MAX_PARAMETERS} parameters");
            return Err(Fault::new(text, text.len(), what));
        }
        if let Some((_, rate, _)) = &self.state
            && self.output != Output::Torque
        {
            let what = "a state belongs to a torque; friction, voltage, torque_constant and angle have none";
            return Err(Fault::new(text, rate.at, what));
        }
        Ok(())
    }

    fn new_name(&self, text: &str, at: usize, name: &str) -> Result<(), Fault> {
        let taken = found(&VARIABLES, name).is_some()
            || found(&FUNCTIONS, name).is_some()
            || found(&PLACES, name).is_some()
            || self.state.as_ref().is_some_and(|(state, ..)| state == name)
            || self.parameters.iter().any(|p| p.name == name)
            || self.fixed.iter().any(|p| p.name == name);
        if taken {
            return Err(Fault::new(text, at, format!("`{name}` is a name already")));
        }
        Ok(())
    }

    /// Says what the names mean.
    fn resolve(&mut self, text: &str) -> Result<(), Fault> {
        let mut law = self.law.clone();
        self.meant(text, &mut law)?;
        self.law = law;
        if let Some((name, mut rate, range)) = self.state.take() {
            self.state = Some((name.clone(), rate.clone(), range));
            self.meant(text, &mut rate)?;
            self.state = Some((name, rate, range));
        }
        Ok(())
    }

    fn meant(&self, text: &str, expression: &mut Expression) -> Result<(), Fault> {
        let at = expression.at;
        match &mut expression.term {
            Term::Name(name) => {
                let term = self.term(name).ok_or_else(|| {
                    let variables: Vec<&str> = VARIABLES.iter().map(|(name, _)| *name).collect();
                    let what = format!(
                        "`{name}` is neither a variable ({}) nor a parameter; state its range: {name} in [low, high] unit",
                        variables.join(", ")
                    );
                    Fault::new(text, at, what)
                })?;
                if let Term::Variable(variable) = term {
                    self.is_at_hand(variable)
                        .map_err(|what| Fault::new(text, at, what))?;
                }
                expression.term = term;
            }
            Term::Negative(inner) => self.meant(text, inner)?,
            Term::Call(_, arguments) => {
                for argument in arguments {
                    self.meant(text, argument)?;
                }
            }
            Term::Binary(_, a, b) => {
                self.meant(text, a)?;
                self.meant(text, b)?;
            }
            _ => {}
        }
        Ok(())
    }

    fn term(&self, name: &str) -> Option<Term> {
        if let Some(variable) = found(&VARIABLES, name) {
            return Some(Term::Variable(variable));
        }
        if self.state.as_ref().is_some_and(|(state, ..)| state == name) {
            return Some(Term::State);
        }
        let parameter = self.parameters.iter().position(|p| p.name == name);
        let fixed = || self.fixed.iter().position(|p| p.name == name);
        parameter
            .map(Term::Parameter)
            .or_else(|| fixed().map(Term::Fixed))
    }

    /// Whether the law may depend on the time, which it remembers in its state's place.
    fn may_age(&self) -> Result<(), String> {
        if self.state.is_some() {
            return Err("a law with a state has no t".to_owned());
        }
        match self.output {
            Output::Torque | Output::TorqueConstant => Ok(()),
            _ => {
                Err("t, the time, belongs to `torque = ...` or `torque_constant = ...`".to_owned())
            }
        }
    }

    /// Whether the place sees a variable.
    fn is_at_hand(&self, variable: Variable) -> Result<(), String> {
        if variable == Variable::Time {
            return self.may_age();
        }
        let voltage = self.output == Output::Voltage;
        let along_angle = matches!(self.output, Output::Angle | Output::Inertia);
        let seen = match variable {
            Variable::Command => voltage,
            Variable::Angle => !voltage,
            _ => !voltage && !along_angle,
        };
        if seen {
            return Ok(());
        }
        Err(match self.output {
            Output::Voltage => "a voltage depends on u, the command, alone",
            Output::Angle => "an error of the angle depends on theta alone",
            Output::Inertia => "an inertia depends on theta alone",
            _ => "u, the command, belongs to `voltage = ...`",
        }
        .to_owned())
    }
}

/// A start for a search where none is stated.
fn middle(low: f64, high: f64) -> f64 {
    if low > 0.0 {
        (low * high).sqrt()
    } else {
        low.max(0.0).max(0.1 * high).min(high)
    }
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
