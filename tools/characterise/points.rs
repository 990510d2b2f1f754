//! A real pattern of points: its dispersion, the laws that fit its counts, and a random pattern of the same kind.

use crate::{
    chart::{Panel, pictures_and_chart},
    counts::Counts,
    files, histogram,
    note::Note,
    options::{PointsOptions, WindowOption},
    pattern_picture,
    table::{MOST_BYTES, Table, read_table},
    verdict::{CONFIDENCE, Verdict},
    window::{Shape, Window},
    words::{FITS, about_laws, about_places},
};
use bevy::math::DVec2;
use bevy_windwood::{
    SettingError,
    scatter::counts::{CountKind, CountLaw, CountModel, Dispersion, Fit, by_moments, characterise, dispersion},
};
use serde_json::{Value, json};
use std::path::Path;

/// Least number of points: fewer do not fill the three classes of five quadrats that the tests need.
const LEAST_POINTS: usize = 20;
/// How many times as wide other quadrats are that are tried where no law fits.
const OTHER_QUADRATS: [f64; 5] = [2.0, 3.0, 4.0, 0.5, 1.5];
/// Points in one of them, on average, above which they are not tried: the search takes the square of it.
const MOST_ON_AVERAGE: f64 = 30.0;
/// Degrees of freedom that its test must have: with fewer everything fits.
const LEAST_DEGREES: f64 = 3.0;

/// A pattern and its analysis.
struct Analysis {
    window: Window,
    points: Vec<DVec2>,
    /// What is odd about the table and the places.
    notes: Vec<Note>,
    /// Whether a law fits.
    about_laws: Note,
    counts: Counts,
    dispersion: Dispersion,
    /// The best first.
    fits: Vec<Fit>,
}

/// A row of the printed table: a law by both methods, where they have a result.
struct Row {
    kind: CountKind,
    likelihood: Option<Fit>,
    moments: Option<CountLaw>,
}

/// Characterises the pattern that `options` name.
///
/// # Errors
/// In one line, naming the file and what is wrong with it.
pub fn run(options: &PointsOptions) -> Result<(), String> {
    let named = |error: String| format!("{}: {error}", options.file.display());
    let window = match &options.window {
        WindowOption::Given(window) => window.clone(),
        WindowOption::PolygonFile(file) => polygon(file)?,
    };
    let bytes = files::read(&options.file, MOST_BYTES)?;
    let columns = options.columns.as_ref().map(|columns| &columns.0);
    let table = read_table(&bytes, columns, |place| require_inside(place, &window)).map_err(named)?;
    if table.points.len() < LEAST_POINTS {
        return Err(named(format!("there are {} points, but must be at least {LEAST_POINTS}", table.points.len())));
    }
    let analysis = Analysis::of(table, window, options.quadrats).map_err(|error| named(error.to_string()))?;
    analysis.print();
    files::write_json(options.json.as_deref(), &analysis.to_json(options.seed))?;
    let simulated = analysis.counts.simulate(analysis.best().model(), options.seed);
    let simulated = simulated.map_err(|error| named(error.to_string()))?;
    let panels = [
        Panel {
            caption: format!("real: {} points, {}", analysis.points.len(), Verdict::of(&analysis.dispersion).name()),
            picture: pattern_picture::draw(&analysis.points, &analysis.window),
        },
        Panel {
            caption: format!("simulated: {}, seed {}", analysis.best().model().kind().name(), options.seed),
            picture: pattern_picture::draw(&simulated, &analysis.window),
        },
    ];
    let name = options.file.file_name().unwrap_or_default().to_string_lossy();
    let title = format!("{name:.60}: real and simulated");
    let figure = pictures_and_chart(&title, &panels, "Points in a quadrat", |area| {
        histogram::draw(area, &analysis.counts.table, analysis.best())
    })?;
    files::write_picture(&options.out, &figure)
}

/// The window whose corners are in a file.
fn polygon(file: &Path) -> Result<Window, String> {
    let named = |error: String| format!("{}: {error}", file.display());
    let corners = read_table(&files::read(file, MOST_BYTES)?, None, |_| Ok(())).map_err(named)?;
    corners.notes.iter().for_each(Note::print);
    Window::polygon(corners.points).map_err(named)
}

fn require_inside(place: DVec2, window: &Window) -> Result<(), String> {
    if window.contains(place) {
        return Ok(());
    }
    let allowed = match window.shape {
        Shape::Rectangle => format!("from {} to {}", window.min_m, window.max_m),
        _ => format!("in {}, which lies from {} to {}", window.describe(), window.min_m, window.max_m),
    };
    Err(format!("the point {place} is outside the window, but must be {allowed}"))
}

/// Quadrats, columns and rows, with which a law fits.
fn other_quadrats(points: &[DVec2], window: &Window, counts: &Counts) -> Option<[u32; 2]> {
    let fits = |quadrats: &[u32; 2]| {
        let counts = Counts::of(points, window, Some((quadrats[0], quadrats[1]))).ok()?;
        let laws = characterise(&counts.table).ok()?;
        laws.iter()
            .filter_map(|fit| fit.goodness)
            .find(|test| test.p >= FITS && test.degrees_of_freedom >= LEAST_DEGREES)
    };
    let times_wider = |factor: f64| {
        let across = |quadrats: u32| ((f64::from(quadrats) / factor).round() as u32).clamp(1, 4096);
        (counts.table.mean() * factor * factor <= MOST_ON_AVERAGE)
            .then(|| [across(counts.grid.columns()), across(counts.grid.rows())])
    };
    OTHER_QUADRATS.into_iter().filter_map(times_wider).find(|quadrats| fits(quadrats).is_some())
}

impl Analysis {
    fn of(table: Table, window: Window, quadrats: Option<(u32, u32)>) -> Result<Self, SettingError> {
        let Table { points, mut notes } = table;
        let counts = Counts::of(&points, &window, quadrats)?;
        let fits = characterise(&counts.table)?;
        notes.extend(about_places(&points, &window, counts.grid.quadrat_m()));
        let left_out = points.len() - counts.points;
        if left_out > 0 {
            notes.push(Note::new(format!(
                "{left_out} points lie in quadrats that reach over the edge of the window, which do not count"
            )));
        }
        let is_fitted = fits.iter().any(|fit| fit.goodness.is_some_and(|goodness| goodness.p >= FITS));
        let others = if is_fitted { None } else { other_quadrats(&points, &window, &counts) };
        let about_laws = about_laws(&fits, others);
        Ok(Self { window, points, notes, about_laws, dispersion: dispersion(&counts.table), counts, fits })
    }

    fn best(&self) -> &CountLaw {
        // There is always one: Poisson's law is never left out.
        &self.fits[0].law
    }

    /// All laws: first those that were ranked, then the others.
    fn rows(&self) -> Vec<Row> {
        let row = |kind, likelihood| Row { kind, likelihood, moments: by_moments(kind, &self.counts.table) };
        let ranked: Vec<CountKind> = self.fits.iter().map(|fit| fit.law.model().kind()).collect();
        let left_out = CountKind::ALL.into_iter().filter(|kind| !ranked.contains(kind));
        let fitted = self.fits.iter().map(|fit| row(fit.law.model().kind(), Some(*fit)));
        fitted.chain(left_out.map(|kind| row(kind, None))).collect()
    }

    fn print(&self) {
        self.notes.iter().for_each(Note::print);
        let Counts { grid, table, .. } = &self.counts;
        let quadrat_m = grid.quadrat_m();
        println!("{} points in {}", self.points.len(), self.window.describe());
        let inside = match self.counts.quadrats() {
            all if all == grid.quadrats() => String::new(),
            inside => format!("{inside} of "),
        };
        println!(
            "{inside}{} x {} quadrats of {:.4} x {:.4} m hold {:.4} points on average, variance {:.4}",
            grid.columns(),
            grid.rows(),
            quadrat_m.x,
            quadrat_m.y,
            table.mean(),
            table.variance()
        );
        let Dispersion { index, chi_square, degrees_of_freedom, .. } = self.dispersion;
        let [low, high] = self.dispersion.range_if_random(CONFIDENCE);
        let verdict = Verdict::of(&self.dispersion).name();
        println!("index of dispersion {index:.4}: {verdict}; 95 of 100 random patterns have {low:.4} to {high:.4}");
        println!("chi-square {chi_square:.1} with {degrees_of_freedom} degrees of freedom");
        println!("{:<26} {:>12} {:>8} {:>7}   {:<22} by moments", "law", "AIC", "behind", "p", "by likelihood");
        for Row { kind, likelihood, moments } in self.rows() {
            let number = |value: Option<f64>, decimals| value.map_or("-".into(), |value| format!("{value:.decimals$}"));
            let aic = likelihood.map(|fit| fit.aic);
            println!(
                "{:<26} {:>12} {:>8} {:>7}   {:<22} {}",
                kind.name(),
                number(aic, 1),
                number(aic.map(|aic| aic - self.fits[0].aic), 1),
                number(likelihood.and_then(|fit| fit.goodness).map(|goodness| goodness.p), 4),
                parameters(likelihood.map(|fit| fit.law)),
                parameters(moments)
            );
        }
        self.about_laws.print();
    }

    fn to_json(&self, seed: u64) -> Value {
        let law = |row: Row| {
            let goodness = row.likelihood.and_then(|fit| fit.goodness);
            json!({
                "law": row.kind.name(),
                "aic": row.likelihood.map(|fit| fit.aic),
                "log_likelihood": row.likelihood.map(|fit| fit.log_likelihood),
                "chi_square": goodness.map(|goodness| goodness.chi_square),
                "degrees_of_freedom": goodness.map(|goodness| goodness.degrees_of_freedom),
                "p": goodness.map(|goodness| goodness.p),
                "by_likelihood": row.likelihood.map(|fit| fit.law.model()),
                "by_moments": row.moments.map(|law| law.model()),
            })
        };
        json!({
            "points": self.points.len(),
            "notes": self.notes.iter().chain([&self.about_laws]).map(Note::to_json).collect::<Vec<_>>(),
            "a_law_fits": !self.about_laws.is_warning,
            "window": self.window.describe(),
            "window_m": [self.window.min_m.to_array(), self.window.max_m.to_array()],
            "window_area_m2": self.window.area_m2(),
            "quadrats": [self.counts.grid.columns(), self.counts.grid.rows()],
            "quadrats_inside": self.counts.quadrats(),
            "points_inside": self.counts.points,
            "quadrat_m": self.counts.grid.quadrat_m().to_array(),
            "quadrats_with": self.counts.table.quadrats_with(),
            "mean": self.counts.table.mean(),
            "variance": self.counts.table.variance(),
            "dispersion": {
                "index": self.dispersion.index,
                "index_if_random": self.dispersion.range_if_random(CONFIDENCE),
                "chi_square": self.dispersion.chi_square,
                "degrees_of_freedom": self.dispersion.degrees_of_freedom,
                "p_clustered": self.dispersion.p_clustered,
                "p_regular": self.dispersion.p_regular,
                "verdict": Verdict::of(&self.dispersion).name(),
            },
            "laws": self.rows().into_iter().map(law).collect::<Vec<_>>(),
            "seed": seed,
        })
    }
}

/// The parameters of a law besides the mean, which is that of the sample.
fn parameters(law: Option<CountLaw>) -> String {
    match law.map(|law| law.model()) {
        None => "-".to_owned(),
        Some(CountModel::Poisson) => "the mean alone".to_owned(),
        Some(CountModel::Binomial { n }) => format!("n {n}"),
        Some(CountModel::NegativeBinomial { k }) => format!("k {k:.4}"),
        Some(CountModel::PoissonPoisson { clump }) => format!("clump {clump:.4}"),
        Some(CountModel::PoissonBinomial { n, p }) => format!("n {n}, p {p:.4}"),
        Some(CountModel::PoissonNegativeBinomial { k, p }) => format!("k {k:.4}, p {p:.4}"),
    }
}
