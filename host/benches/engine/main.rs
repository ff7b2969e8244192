//! How fast the engine is, in rows of CPU times and of ratios to the plain explicit Euler step of the linear motor in
//! scalar f64, as the paper's authors would write it. `cargo bench -p host --bench engine [part]`, where a part is one
//! of `linear`, `peers`, `effects`, `lengths`, `whole`; all of them without.
#![forbid(unsafe_code)]

mod clock;
mod effects;
mod euler;
mod lengths;
mod linear;
mod peers;
mod whole;

fn main() {
    let parts: [(&str, fn()); 5] = [
        ("linear", linear::rows),
        ("peers", peers::rows),
        ("effects", effects::rows),
        ("lengths", lengths::rows),
        ("whole", whole::rows),
    ];
    let asked: Vec<String> = std::env::args()
        .skip(1)
        .filter(|argument| !argument.starts_with('-'))
        .collect();
    for (name, rows) in parts {
        if asked.is_empty() || asked.iter().any(|asked| asked == name) {
            println!("## {name}\n");
            rows();
            println!();
        }
    }
}
