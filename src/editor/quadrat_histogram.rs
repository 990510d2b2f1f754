//! How many quadrats of an area hold so many plants, beside what the area's law says of them.

use bevy::math::{DVec2, IVec2};

use crate::{
    ground::LevelGround,
    scatter::{
        ForestPlan, Planter,
        counts::{Frequencies, Probabilities, goodness_of_fit},
        plan::{Area, GroundLimits, Shape, Stock},
    },
};

/// Quadrats and plants that are counted, at most: the middle of a larger area.
const MOST_QUADRATS: f64 = 40_000.0;
const MOST_PLANTS: f64 = 200_000.0;
/// An area with fewer whole quadrats is counted on open ground around its middle.
const FEWEST_QUADRATS: usize = 60;
/// Quadrats along a side of that ground.
const OPEN_SIDE: f64 = 100.0;

/// The counts of an area's quadrats.
#[derive(Clone, Debug, PartialEq)]
pub struct QuadratHistogram {
    /// How many quadrats hold 0, 1, 2, ... plants.
    pub observed: Vec<u64>,
    /// How many would by the law; as many entries.
    pub expected: Vec<f64>,
    /// Side of a quadrat, m.
    pub quadrat_m: f64,
    /// Plants in a quadrat: mean, and variance over mean.
    pub mean: f64,
    pub index: f64,
    /// The same by the law.
    pub law_mean: f64,
    pub law_index: f64,
    /// Probability that a pattern of the law differs from it as much as this one or more; none where there are too few classes.
    pub p: Option<f64>,
    /// Whether the quadrats are those of the area; else of ground about its middle, for too few whole ones are in its outline, or it
    /// thins out.
    pub is_in_outline: bool,
}

impl QuadratHistogram {
    /// Counts the plants of an area, as the plan plants it alone: without other areas, what is kept free and limits of the ground.
    ///
    /// # Errors
    /// Where there is no such area, it is not valid, or nothing grows in it.
    pub fn of(plan: &ForestPlan, number: usize) -> Result<Self, String> {
        let area = plan.areas.get(number).ok_or("There is no such area")?;
        if area.density_per_ha <= 0.0 {
            return Err("Nothing grows here".into());
        }
        let law = area.law().map_err(|error| error.to_string())?;
        let quadrat_m = f64::from(area.quadrat_side_m());
        let most = MOST_QUADRATS.min(MOST_PLANTS / law.mean()).max(2.0 * FEWEST_QUADRATS as f64);
        let [min, max] = area.shape.bounds_m().map(|corner| DVec2::new(f64::from(corner[0]), f64::from(corner[1])));
        let side = most.sqrt().floor();
        let window = Window::about(0.5 * (min + max), (max - min).min(DVec2::splat(side * quadrat_m)), quadrat_m);
        let whole = window.whole_quadrats(&area.shape);
        let is_in_outline = whole.iter().filter(|is_whole| **is_whole).count() >= FEWEST_QUADRATS;
        let (window, whole, shape) = if is_in_outline {
            (window, whole, area.shape.clone())
        } else {
            let side_m = side.min(OPEN_SIDE) * quadrat_m;
            let open = Window::about(0.5 * (min + max), DVec2::splat(side_m), quadrat_m);
            (open, vec![true; open.quadrats()], open.shape())
        };
        let counts = window.counts(&alone(plan, number, shape))?;
        let counts: Vec<u32> =
            counts.into_iter().zip(whole).filter(|(_, is_whole)| *is_whole).map(|(n, _)| n).collect();
        let table = Frequencies::of_counts(&counts).map_err(|error| error.to_string())?;
        let probabilities = Probabilities::new(&law);
        let entries =
            table.quadrats_with().len().max(probabilities.as_slice().iter().rposition(|p| *p > 1e-4).unwrap_or(0) + 1);
        let mut observed = table.quadrats_with().to_vec();
        observed.resize(entries, 0);
        Ok(Self {
            observed,
            expected: (0..entries).map(|count| table.quadrats() * probabilities.of(count)).collect(),
            quadrat_m,
            mean: table.mean(),
            index: table.variance() / table.mean(),
            law_mean: law.mean(),
            law_index: law.variance() / law.mean(),
            p: goodness_of_fit(&law, &table, 0).map(|fit| fit.p),
            is_in_outline,
        })
    }

    /// Number of quadrats.
    pub fn quadrats(&self) -> u64 {
        self.observed.iter().sum()
    }
}

/// The plan with one area alone, on any ground, with a shape. The others stay as empty ones: an area's random numbers depend on its number.
fn alone(plan: &ForestPlan, number: usize, shape: Shape) -> ForestPlan {
    let any = GroundLimits::default();
    let mut areas = vec![Area { density_per_ha: 0.0, ..Area::default() }; number];
    let area = plan.areas[number].clone();
    let stock = area.stock.iter().map(|stock| Stock { ground: any, ..stock.clone() }).collect();
    areas.push(Area { shape, ground: any, stock, ..area });
    ForestPlan { areas, keep_out: Vec::new(), more_species: Vec::new(), ..plan.clone() }
}

/// A rectangle of quadrats, of the endless grid of an area.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Window {
    first: IVec2,
    size: IVec2,
    quadrat_m: f64,
}

impl Window {
    fn about(middle: DVec2, size_m: DVec2, quadrat_m: f64) -> Self {
        let first = ((middle - 0.5 * size_m) / quadrat_m).floor().as_ivec2();
        let last = ((middle + 0.5 * size_m) / quadrat_m).floor().as_ivec2();
        Self { first, size: (last - first + 1).max(IVec2::splat(2)), quadrat_m }
    }

    fn quadrats(&self) -> usize {
        self.size.x as usize * self.size.y as usize
    }

    fn corner_m(&self, index: usize) -> DVec2 {
        let at = IVec2::new(index as i32 % self.size.x, index as i32 / self.size.x);
        (self.first + at).as_dvec2() * self.quadrat_m
    }

    fn shape(&self) -> Shape {
        // A margin, so that no plant at the border is lost in rounding.
        let min = self.first.as_dvec2() * self.quadrat_m - 1.0;
        let max = (self.first + self.size).as_dvec2() * self.quadrat_m + 1.0;
        Shape::Rectangle { min_m: min.as_vec2().into(), max_m: max.as_vec2().into() }
    }

    /// Which quadrats a shape covers as a whole, by nine places of each.
    fn whole_quadrats(&self, shape: &Shape) -> Vec<bool> {
        let places = (0..self.quadrats()).flat_map(|index| {
            let corner = self.corner_m(index);
            let place = move |number: u32| {
                corner + 0.5 * self.quadrat_m * DVec2::new(f64::from(number % 3), f64::from(number / 3))
            };
            (0..9).map(place)
        });
        let shares: Vec<f32> = shape.coverage(places.collect::<Vec<_>>()).collect();
        shares.chunks_exact(9).map(|shares| shares.iter().all(|share| *share > 0.999)).collect()
    }

    /// The number of plants in each quadrat.
    fn counts(&self, plan: &ForestPlan) -> Result<Vec<u32>, String> {
        let planter = Planter::new(plan).map_err(|error| error.to_string())?;
        let cell_m = f64::from(planter.cell_m());
        let cell = |place: DVec2| (place / cell_m).floor().as_ivec2();
        let first = cell(self.first.as_dvec2() * self.quadrat_m);
        let last = cell((self.first + self.size).as_dvec2() * self.quadrat_m);
        let mut counts = vec![0; self.quadrats()];
        let mut planted = Vec::new();
        for z in first.y..=last.y {
            for x in first.x..=last.x {
                planter.plant(IVec2::new(x, z), &LevelGround::default(), &mut planted);
                for plant in &planted {
                    let place = DVec2::new(f64::from(plant.position.x), f64::from(plant.position.z));
                    let at = (place / self.quadrat_m).floor().as_ivec2() - self.first;
                    if at.cmpge(IVec2::ZERO).all() && at.cmplt(self.size).all() {
                        counts[(at.y * self.size.x + at.x) as usize] += 1;
                    }
                }
            }
        }
        Ok(counts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scatter::counts::CountModel;

    fn plan(pattern: CountModel, least_distance_m: f32) -> ForestPlan {
        let shape = Shape::Rectangle { min_m: [-400.0; 2], max_m: [400.0; 2] };
        let area = Area { shape, pattern, density_per_ha: 160.0, least_distance_m, ..Area::default() };
        ForestPlan { areas: vec![Area::default(), area], ..ForestPlan::default() }
    }

    #[test]
    fn what_is_planted_follows_the_law() {
        let laws = [
            CountModel::Poisson,
            CountModel::Binomial { n: 4 },
            CountModel::NegativeBinomial { k: 1.5 },
            CountModel::PoissonPoisson { clump: 3.0 },
        ];
        for law in laws {
            let histogram = QuadratHistogram::of(&plan(law, 0.0), 1).unwrap();
            assert!(histogram.is_in_outline && histogram.quadrats() > 9000, "{law:?}: {}", histogram.quadrats());
            assert!((histogram.mean / histogram.law_mean - 1.0).abs() < 0.06, "{law:?}: {histogram:?}");
            assert!((histogram.index / histogram.law_index - 1.0).abs() < 0.12, "{law:?}: {histogram:?}");
            assert!(histogram.p.unwrap() > 1e-3, "{law:?}: {:?}", histogram.p);
            let expected: f64 = histogram.expected.iter().sum();
            assert!((expected / histogram.quadrats() as f64 - 1.0).abs() < 1e-3);
            assert_eq!(histogram.observed.len(), histogram.expected.len());
        }
    }

    #[test]
    fn a_least_distance_is_seen_as_a_loss() {
        let [far, near] =
            [4.0, 0.0].map(|distance| QuadratHistogram::of(&plan(CountModel::Poisson, distance), 1).unwrap());
        assert!(far.mean < 0.9 * near.mean && far.law_mean == near.law_mean);
        // Of a random pattern the index has a standard deviation of sqrt(2 / quadrats).
        let deviation = (2.0 / far.quadrats() as f64).sqrt();
        assert!(far.index < 1.0 - 4.0 * deviation && far.p.unwrap() < 1e-6, "{far:?}");
    }

    #[test]
    fn a_small_area_and_a_mask_are_counted_on_open_ground() {
        let mixed = ForestPlan::from_ron(include_str!("../../assets/forests/mixed.forest.ron")).unwrap();
        let histograms: Vec<_> = (0..3).map(|number| QuadratHistogram::of(&mixed, number).unwrap()).collect();
        assert!(histograms[0].is_in_outline && histograms[1].is_in_outline && !histograms[2].is_in_outline);
        assert!((histograms[2].mean / histograms[2].law_mean - 1.0).abs() < 0.2, "{:?}", histograms[2]);
        assert!(QuadratHistogram::of(&mixed, 3).is_err());
        let mut bare = mixed;
        bare.areas[0].density_per_ha = 0.0;
        assert_eq!(QuadratHistogram::of(&bare, 0), Err("Nothing grows here".into()));
    }
}
