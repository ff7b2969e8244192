//! Profiles of all parameters in one drawing: the signed root of the deviance against the distance in standard errors. What is
//! straight is as its standard error says (the profile t plot of D. M. Bates and D. G. Watts, *Nonlinear Regression Analysis*, 1988,
//! ch. 6).

use super::chart::{Chart, scatter, stroke};
use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use crate::number_text::{interval, short};
use crate::schema::profile::Profile;
use servoid_identify::fit::RISE_95;

/// Standard errors to both sides that are shown.
const SHOWN: f64 = 4.0;

/// Draws the profiles. `None` where there are none.
pub fn profiles(id: &str, profiles: &[Profile]) -> Option<Picture> {
    if profiles.is_empty() {
        return None;
    }
    let mut plot = Chart::default();
    let flat = |height: f64| (vec![-SHOWN, SHOWN], vec![height, height]);
    let straight = (vec![-SHOWN, SHOWN], vec![-SHOWN, SHOWN]);
    let root = RISE_95.sqrt();
    for (k, (x, y)) in [straight, flat(root), flat(-root)].into_iter().enumerate() {
        let name = if k == 0 {
            "as the standard error says"
        } else {
            "95 %"
        };
        let dash = if k == 0 { "solid" } else { "dash" };
        plot.add(
            scatter(x, y)
                .set("name", name)
                .set("showlegend", k < 2)
                .set("mode", "lines")
                .set("line", stroke(colour::QUIET, 1.0).set("dash", dash)),
        );
    }
    let drawn = profiles
        .iter()
        .filter_map(|profile| Some((profile, profile.std?)));
    for (k, (profile, std)) in drawn.enumerate() {
        let (x, y): (Vec<f64>, Vec<f64>) = (profile.points.iter())
            .map(|point| {
                let distance = (point.value - profile.best) / std;
                (distance, distance.signum() * point.deviance.sqrt())
            })
            .filter(|(x, y)| x.abs() <= SHOWN && y.abs() <= SHOWN)
            .map(|(x, y)| (rounded(x), rounded(y)))
            .unzip();
        plot.add(
            scatter(x, y)
                .set("name", &profile.name)
                .set("mode", "lines+markers")
                .set("line", stroke(colour::of(k), 1.8)),
        );
    }
    plot.lay_out(
        layout(440)
            .set(
                "xaxis",
                axis("distance from the best value, standard errors"),
            )
            .set("yaxis", axis("signed root of the deviance")),
    );
    let mut table = Table::new(&["parameter", "best", "95 % interval"]);
    for profile in profiles {
        let text = interval([profile.low, profile.high], &profile.unit);
        table.row([
            profile.name.clone(),
            format!("{} {}", short(profile.best), profile.unit),
            text.unwrap_or_else(|| "not bounded".to_owned()),
        ]);
    }
    Some(Picture {
        id: id.to_owned(),
        title: "Profile likelihood".to_owned(),
        caption: "Each parameter is held at other values while the rest follows. A straight line is a parameter whose standard error \
                  says all; where a line bends, its interval, which ends at the dashes, is not symmetric. A line that stays \
                  within them has no bound on that side."
            .to_owned(),
        drawing: Drawing::Chart(plot),
        table: Some(table),
    })
}
