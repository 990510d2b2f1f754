//! A real pattern of points: its dispersion, the laws that fit its counts, and a random pattern of the same kind.

use crate::{
    chart::{Panel, pictures_and_chart},
    csv_points::{MOST_BYTES, read_points},
    files, histogram,
    options::{PointsOptions, Window},
    pattern_picture,
    verdict::{CONFIDENCE, Verdict},
};
use bevy::math::DVec2;
use bevy_windwood::{
    SettingError,
    scatter::{
        counts::{CountKind, CountLaw, CountModel, Dispersion, Fit, Frequencies, by_moments, characterise, dispersion},
        quadrat::{QuadratGrid, exact_counts, place_points},
    },
};
use rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
use serde_json::{Value, json};

/// Least number of points: fewer do not fill the three classes of five quadrats that the tests need.
const LEAST_POINTS: usize = 20;

/// A pattern and its analysis.
struct Analysis {
    window: Window,
    points: Vec<DVec2>,
    grid: QuadratGrid,
    table: Frequencies,
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
    let bytes = files::read(&options.file, MOST_BYTES)?;
    let points = read_points(&bytes, &options.window).map_err(named)?;
    if points.len() < LEAST_POINTS {
        return Err(named(format!("there are {} points, but must be at least {LEAST_POINTS}", points.len())));
    }
    let analysis = Analysis::of(points, options).map_err(|error| named(error.to_string()))?;
    analysis.print();
    files::write_json(options.json.as_deref(), &analysis.to_json(options.seed))?;
    let simulated = analysis.simulated(options.seed).map_err(|error| named(error.to_string()))?;
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
        histogram::draw(area, &analysis.table, analysis.best())
    })?;
    files::write_picture(&options.out, &figure)
}

impl Analysis {
    fn of(points: Vec<DVec2>, options: &PointsOptions) -> Result<Self, SettingError> {
        let window = options.window;
        let grid = match options.quadrats {
            Some((columns, rows)) => QuadratGrid::new(window.min_m, window.max_m, columns, rows),
            None => QuadratGrid::with_quadrat_for_each(points.len(), window.min_m, window.max_m),
        }?;
        let table = grid.frequencies(&points)?;
        let fits = characterise(&table)?;
        let dispersion = dispersion(&table);
        Ok(Self { window, points, grid, table, dispersion, fits })
    }

    fn best(&self) -> &CountLaw {
        // There is always one: Poisson's law is never left out.
        &self.fits[0].law
    }

    /// All laws: first those that were ranked, then the others.
    fn rows(&self) -> Vec<Row> {
        let row = |kind, likelihood| Row { kind, likelihood, moments: by_moments(kind, &self.table) };
        let ranked: Vec<CountKind> = self.fits.iter().map(|fit| fit.law.model().kind()).collect();
        let left_out = CountKind::ALL.into_iter().filter(|kind| !ranked.contains(kind));
        let fitted = self.fits.iter().map(|fit| row(fit.law.model().kind(), Some(*fit)));
        fitted.chain(left_out.map(|kind| row(kind, None))).collect()
    }

    fn print(&self) {
        let (size_m, quadrat_m) = (self.window.size_m(), self.grid.quadrat_m());
        println!("{} points in {} x {} m", self.points.len(), size_m.x, size_m.y);
        println!(
            "{} x {} quadrats of {:.4} x {:.4} m hold {:.4} points on average, variance {:.4}",
            self.grid.columns(),
            self.grid.rows(),
            quadrat_m.x,
            quadrat_m.y,
            self.table.mean(),
            self.table.variance()
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
            "window_m": [self.window.min_m.to_array(), self.window.max_m.to_array()],
            "quadrats": [self.grid.columns(), self.grid.rows()],
            "quadrat_m": self.grid.quadrat_m().to_array(),
            "quadrats_with": self.table.quadrats_with(),
            "mean": self.table.mean(),
            "variance": self.table.variance(),
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

    /// As many points in the same quadrats, by the best law.
    fn simulated(&self, seed: u64) -> Result<Vec<DVec2>, SettingError> {
        let random = &mut Xoshiro256PlusPlus::seed_from_u64(seed);
        let counts = exact_counts(self.best().model(), self.points.len(), self.grid.quadrats(), random)?;
        place_points(&self.grid, &counts, 0.0, random)
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
