//! Laws that were stated as text, as `servoid effects --emit-rust` writes them.

use shared::effects::formula::{Formula, Op, Output, Program, State, Variable};
use shared::effects::{Description, Facts, Parameter, Place};
use shared::units::Quantity;

/// `drag: torque = -c*sgn(w)*abs(w/w0)^p; c = 1.2 in [0, 10] V; p = 0.5 in [0.1, 4]; w0 = 100 rad/s`
pub static DRAG: Formula = Formula {
    description: Description {
        name: "drag",
        place: Place::Torque,
        title: "law as stated",
        parameters: &[
            Parameter {
                name: "c",
                quantity: Quantity::Stated("V"),
                range: (0.0, 10.0),
                widest: 10.0,
                typical: 1.2,
                amplitude: true,
                neutral: Some(0.0),
                form: None,
            },
            Parameter {
                name: "p",
                quantity: Quantity::Stated("1"),
                range: (0.1, 4.0),
                widest: 4.0,
                typical: 0.5,
                amplitude: false,
                neutral: None,
                form: None,
            },
        ],
        equation: "drag: torque = -c*sgn(w)*abs(w/w0)^p; c = 1.2 in [0, 10] V; p = 0.5 in [0.1, 4]; w0 = 100 rad/s",
        signature: "as its equation says",
        exposed_by: "what makes its variables large and small apart from each other",
        look_alikes: &[],
        source: "stated by the user",
        facts: Facts {
            series_parallel: true,
            ..Facts::PLAIN
        },
    },
    program: Program {
        output: Output::Torque,
        constants: &[
            &[Op::Parameter(0), Op::Neg],
            &[Op::Number(1.0), Op::Number(100.0), Op::Div],
            &[Op::Parameter(1)],
        ],
        law: &[
            Op::Variable(Variable::Speed),
            Op::Sign,
            Op::Scale(0),
            Op::Variable(Variable::Speed),
            Op::Scale(1),
            Op::Abs,
            Op::Raise(2),
            Op::Mul,
        ],
        states: &[],
    },
};

/// `falling: friction = c*exp(-abs(w)/ws); c = 0.8 in [0, 5] V; ws = 40 in [2, 200] rad/s`
pub static FALLING: Formula = Formula {
    description: Description {
        name: "falling",
        place: Place::Friction,
        title: "law as stated",
        parameters: &[
            Parameter {
                name: "c",
                quantity: Quantity::Stated("V"),
                range: (0.0, 5.0),
                widest: 5.0,
                typical: 0.8,
                amplitude: true,
                neutral: Some(0.0),
                form: None,
            },
            Parameter {
                name: "ws",
                quantity: Quantity::Stated("rad/s"),
                range: (2.0, 200.0),
                widest: 200.0,
                typical: 40.0,
                amplitude: false,
                neutral: None,
                form: None,
            },
        ],
        equation: "falling: friction = c*exp(-abs(w)/ws); c = 0.8 in [0, 5] V; ws = 40 in [2, 200] rad/s",
        signature: "as its equation says",
        exposed_by: "what makes its variables large and small apart from each other",
        look_alikes: &[],
        source: "stated by the user",
        facts: Facts {
            series_parallel: true,
            ..Facts::PLAIN
        },
    },
    program: Program {
        output: Output::Friction,
        constants: &[
            &[Op::Number(1.0), Op::Parameter(1), Op::Div],
            &[Op::Parameter(0)],
        ],
        law: &[
            Op::Variable(Variable::Speed),
            Op::Abs,
            Op::Neg,
            Op::Scale(0),
            Op::Exp,
            Op::Scale(1),
        ],
        states: &[],
    },
};

/// `gear: z' = (w - abs(w)*z)/h; torque = -(ma*abs(tau)*z + md*tau*z^2); h = 0.05 in [1e-3, 1] rad; ma = 0.2 in [0, 1]; md = 0.1 in [0, 1]`
pub static GEAR: Formula = Formula {
    description: Description {
        name: "gear",
        place: Place::Torque,
        title: "law as stated",
        parameters: &[
            Parameter {
                name: "h",
                quantity: Quantity::Stated("rad"),
                range: (0.001, 1.0),
                widest: 1.0,
                typical: 0.05,
                amplitude: false,
                neutral: None,
                form: None,
            },
            Parameter {
                name: "ma",
                quantity: Quantity::Stated("1"),
                range: (0.0, 1.0),
                widest: 1.0,
                typical: 0.2,
                amplitude: true,
                neutral: Some(0.0),
                form: None,
            },
            Parameter {
                name: "md",
                quantity: Quantity::Stated("1"),
                range: (0.0, 1.0),
                widest: 1.0,
                typical: 0.1,
                amplitude: true,
                neutral: Some(0.0),
                form: None,
            },
        ],
        equation: "gear: z' = (w - abs(w)*z)/h; torque = -(ma*abs(tau)*z + md*tau*z^2); h = 0.05 in [1e-3, 1] rad; ma = 0.2 in [0, 1]; md = 0.1 in [0, 1]",
        signature: "as its equation says",
        exposed_by: "what makes its variables large and small apart from each other",
        look_alikes: &[],
        source: "stated by the user",
        facts: Facts {
            series_parallel: false,
            ..Facts::PLAIN
        },
    },
    program: Program {
        output: Output::Torque,
        constants: &[
            &[Op::Parameter(1)],
            &[Op::Parameter(2)],
            &[Op::Number(1.0), Op::Parameter(0), Op::Div],
        ],
        law: &[
            Op::Variable(Variable::Current),
            Op::Abs,
            Op::Scale(0),
            Op::State(0),
            Op::Mul,
            Op::Variable(Variable::Current),
            Op::Scale(1),
            Op::State(0),
            Op::Square,
            Op::Mul,
            Op::Add,
            Op::Neg,
        ],
        states: &[State {
            rate: &[
                Op::Variable(Variable::Speed),
                Op::Variable(Variable::Speed),
                Op::Abs,
                Op::State(0),
                Op::Mul,
                Op::Sub,
                Op::Scale(2),
            ],
            range: (-1.0, 1.0),
        }],
    },
};

/// `steps: voltage = -c*min(abs(u)/u0, 1)*sgn(u); c = 0.4 in [0, 2] V; u0 = 2 V`
pub static STEPS: Formula = Formula {
    description: Description {
        name: "steps",
        place: Place::Drive,
        title: "law as stated",
        parameters: &[Parameter {
            name: "c",
            quantity: Quantity::Stated("V"),
            range: (0.0, 2.0),
            widest: 2.0,
            typical: 0.4,
            amplitude: true,
            neutral: Some(0.0),
            form: None,
        }],
        equation: "steps: voltage = -c*min(abs(u)/u0, 1)*sgn(u); c = 0.4 in [0, 2] V; u0 = 2 V",
        signature: "as its equation says",
        exposed_by: "what makes its variables large and small apart from each other",
        look_alikes: &[],
        source: "stated by the user",
        facts: Facts {
            series_parallel: true,
            ..Facts::PLAIN
        },
    },
    program: Program {
        output: Output::Voltage,
        constants: &[
            &[Op::Number(1.0), Op::Number(2.0), Op::Div],
            &[Op::Number(1.0)],
            &[Op::Parameter(0), Op::Neg],
        ],
        law: &[
            Op::Variable(Variable::Command),
            Op::Abs,
            Op::Scale(0),
            Op::Constant(1),
            Op::Min,
            Op::Scale(2),
            Op::Variable(Variable::Command),
            Op::Sign,
            Op::Mul,
        ],
        states: &[],
    },
};

/// `teeth: torque = -(a*cos(12*theta) + b*tanh(i/v0)*sin(theta)); a = 0.3 in [-1, 1] V; b = 0.2 in [-1, 1] V; v0 = 3 V`
pub static TEETH: Formula = Formula {
    description: Description {
        name: "teeth",
        place: Place::Torque,
        title: "law as stated",
        parameters: &[
            Parameter {
                name: "a",
                quantity: Quantity::Stated("V"),
                range: (-1.0, 1.0),
                widest: 1.0,
                typical: 0.3,
                amplitude: true,
                neutral: Some(0.0),
                form: None,
            },
            Parameter {
                name: "b",
                quantity: Quantity::Stated("V"),
                range: (-1.0, 1.0),
                widest: 1.0,
                typical: 0.2,
                amplitude: true,
                neutral: Some(0.0),
                form: None,
            },
        ],
        equation: "teeth: torque = -(a*cos(12*theta) + b*tanh(i/v0)*sin(theta)); a = 0.3 in [-1, 1] V; b = 0.2 in [-1, 1] V; v0 = 3 V",
        signature: "as its equation says",
        exposed_by: "what makes its variables large and small apart from each other",
        look_alikes: &[],
        source: "stated by the user",
        facts: Facts {
            series_parallel: true,
            ..Facts::PLAIN
        },
    },
    program: Program {
        output: Output::Torque,
        constants: &[
            &[Op::Number(12.0)],
            &[Op::Parameter(0)],
            &[Op::Number(1.0), Op::Number(3.0), Op::Div],
            &[Op::Parameter(1)],
        ],
        law: &[
            Op::Variable(Variable::Angle),
            Op::Scale(0),
            Op::Cos,
            Op::Scale(1),
            Op::Variable(Variable::Current),
            Op::Scale(2),
            Op::Tanh,
            Op::Scale(3),
            Op::Variable(Variable::Angle),
            Op::Sin,
            Op::Mul,
            Op::Add,
            Op::Neg,
        ],
        states: &[],
    },
};

/// `weak: torque_constant = 1 - k*max(abs(i)/v0 - 0.5, 0)/(1 + (i/v0)^2); k = 0.2 in [0, 1]; v0 = 12 V`
pub static WEAK: Formula = Formula {
    description: Description {
        name: "weak",
        place: Place::Torque,
        title: "law as stated",
        parameters: &[Parameter {
            name: "k",
            quantity: Quantity::Stated("1"),
            range: (0.0, 1.0),
            widest: 1.0,
            typical: 0.2,
            amplitude: true,
            neutral: Some(0.0),
            form: None,
        }],
        equation: "weak: torque_constant = 1 - k*max(abs(i)/v0 - 0.5, 0)/(1 + (i/v0)^2); k = 0.2 in [0, 1]; v0 = 12 V",
        signature: "as its equation says",
        exposed_by: "what makes its variables large and small apart from each other",
        look_alikes: &[],
        source: "stated by the user",
        facts: Facts {
            series_parallel: true,
            ..Facts::PLAIN
        },
    },
    program: Program {
        output: Output::TorqueConstant,
        constants: &[
            &[Op::Number(1.0), Op::Number(12.0), Op::Div],
            &[Op::Number(0.5)],
            &[Op::Number(0.0)],
            &[Op::Parameter(0)],
            &[Op::Number(1.0)],
        ],
        law: &[
            Op::Constant(4),
            Op::Variable(Variable::Current),
            Op::Abs,
            Op::Scale(0),
            Op::Constant(1),
            Op::Sub,
            Op::Constant(2),
            Op::Max,
            Op::Scale(3),
            Op::Constant(4),
            Op::Variable(Variable::Current),
            Op::Scale(0),
            Op::Square,
            Op::Add,
            Op::Div,
            Op::Sub,
        ],
        states: &[],
    },
};

/// `ageing: torque = -c*w/w0*(1 - exp(-t/t0)); c = 1.5 in [0, 10] V; t0 = 5 in [0.1, 100] s; w0 = 300 rad/s`
pub static AGEING: Formula = Formula {
    description: Description {
        name: "ageing",
        place: Place::Torque,
        title: "law as stated",
        parameters: &[
            Parameter {
                name: "c",
                quantity: Quantity::Stated("V"),
                range: (0.0, 10.0),
                widest: 10.0,
                typical: 1.5,
                amplitude: true,
                neutral: Some(0.0),
                form: None,
            },
            Parameter {
                name: "t0",
                quantity: Quantity::Stated("s"),
                range: (0.1, 100.0),
                widest: 100.0,
                typical: 5.0,
                amplitude: false,
                neutral: None,
                form: None,
            },
        ],
        equation: "ageing: torque = -c*w/w0*(1 - exp(-t/t0)); c = 1.5 in [0, 10] V; t0 = 5 in [0.1, 100] s; w0 = 300 rad/s",
        signature: "as its equation says",
        exposed_by: "what makes its variables large and small apart from each other",
        look_alikes: &[],
        source: "stated by the user",
        facts: Facts {
            series_parallel: true,
            ..Facts::PLAIN
        },
    },
    program: Program {
        output: Output::Torque,
        constants: &[
            &[Op::Parameter(0), Op::Neg],
            &[Op::Number(1.0), Op::Number(300.0), Op::Div],
            &[Op::Number(1.0), Op::Parameter(1), Op::Div],
            &[Op::Number(1.0)],
        ],
        law: &[
            Op::Variable(Variable::Speed),
            Op::Scale(0),
            Op::Scale(1),
            Op::Constant(3),
            Op::Variable(Variable::Time),
            Op::Neg,
            Op::Scale(2),
            Op::Exp,
            Op::Sub,
            Op::Mul,
        ],
        states: &[],
    },
};

/// `crank: inertia = a*(1 + cos(2*theta - f)); a = 0.3 in [0, 4]; f = 0.7 in [-6.3, 6.3] rad`
pub static CRANK: Formula = Formula {
    description: Description {
        name: "crank",
        place: Place::Torque,
        title: "law as stated",
        parameters: &[
            Parameter {
                name: "a",
                quantity: Quantity::Stated("1"),
                range: (0.0, 4.0),
                widest: 4.0,
                typical: 0.3,
                amplitude: true,
                neutral: Some(0.0),
                form: None,
            },
            Parameter {
                name: "f",
                quantity: Quantity::Stated("rad"),
                range: (-6.3, 6.3),
                widest: 6.3,
                typical: 0.7,
                amplitude: false,
                neutral: None,
                form: None,
            },
        ],
        equation: "crank: inertia = a*(1 + cos(2*theta - f)); a = 0.3 in [0, 4]; f = 0.7 in [-6.3, 6.3] rad",
        signature: "as its equation says",
        exposed_by: "what makes its variables large and small apart from each other",
        look_alikes: &[],
        source: "stated by the user",
        facts: Facts {
            series_parallel: true,
            ..Facts::PLAIN
        },
    },
    program: Program {
        output: Output::Inertia,
        constants: &[
            &[Op::Number(2.0)],
            &[Op::Parameter(1)],
            &[Op::Number(1.0)],
            &[Op::Parameter(0)],
        ],
        law: &[
            Op::Constant(2),
            Op::Variable(Variable::Angle),
            Op::Scale(0),
            Op::Constant(1),
            Op::Sub,
            Op::Cos,
            Op::Add,
            Op::Scale(3),
        ],
        states: &[],
    },
};

/// `mass: x' = w - y; y' = k*x; torque = -c*x; c = 0.4 in [0, 100] V/rad; k = 900 in [1, 1e6] 1/s^2; x in [-1, 1] rad; y in [-2000, 2000] rad/s`
pub static MASS: Formula = Formula {
    description: Description {
        name: "mass",
        place: Place::Torque,
        title: "law as stated",
        parameters: &[
            Parameter {
                name: "c",
                quantity: Quantity::Stated("V/rad"),
                range: (0.0, 100.0),
                widest: 100.0,
                typical: 0.4,
                amplitude: true,
                neutral: Some(0.0),
                form: None,
            },
            Parameter {
                name: "k",
                quantity: Quantity::Stated("1/s^2"),
                range: (1.0, 1000000.0),
                widest: 1000000.0,
                typical: 900.0,
                amplitude: false,
                neutral: None,
                form: None,
            },
        ],
        equation: "mass: x' = w - y; y' = k*x; torque = -c*x; c = 0.4 in [0, 100] V/rad; k = 900 in [1, 1e6] 1/s^2; x in [-1, 1] rad; y in [-2000, 2000] rad/s",
        signature: "as its equation says",
        exposed_by: "what makes its variables large and small apart from each other",
        look_alikes: &[],
        source: "stated by the user",
        facts: Facts {
            series_parallel: false,
            ..Facts::PLAIN
        },
    },
    program: Program {
        output: Output::Torque,
        constants: &[&[Op::Parameter(0), Op::Neg], &[Op::Parameter(1)]],
        law: &[Op::State(0), Op::Scale(0)],
        states: &[
            State {
                rate: &[Op::Variable(Variable::Speed), Op::State(1), Op::Sub],
                range: (-1.0, 1.0),
            },
            State {
                rate: &[Op::State(0), Op::Scale(1)],
                range: (-2000.0, 2000.0),
            },
        ],
    },
};

/// `contact: voltage = -d*i/(e + abs(i)); d = 0.9 in [0, 9] V; e = 1.5 V`
pub static CONTACT: Formula = Formula {
    description: Description {
        name: "contact",
        place: Place::Drive,
        title: "law as stated",
        parameters: &[Parameter {
            name: "d",
            quantity: Quantity::Stated("V"),
            range: (0.0, 9.0),
            widest: 9.0,
            typical: 0.9,
            amplitude: true,
            neutral: Some(0.0),
            form: None,
        }],
        equation: "contact: voltage = -d*i/(e + abs(i)); d = 0.9 in [0, 9] V; e = 1.5 V",
        signature: "as its equation says",
        exposed_by: "what makes its variables large and small apart from each other",
        look_alikes: &[],
        source: "stated by the user",
        facts: Facts {
            series_parallel: true,
            ..Facts::PLAIN
        },
    },
    program: Program {
        output: Output::Voltage,
        constants: &[&[Op::Parameter(0), Op::Neg], &[Op::Number(1.5)]],
        law: &[
            Op::Variable(Variable::Current),
            Op::Scale(0),
            Op::Constant(1),
            Op::Variable(Variable::Current),
            Op::Abs,
            Op::Add,
            Op::Div,
        ],
        states: &[],
    },
};
