//! Plants a plan, cell by cell.

use bevy::math::{DVec2, IVec2, Vec2, Vec3};

use super::{
    index::BoxIndex,
    layer::{Candidate, Layer, Square},
    planted::Planted,
    spacing::keep_apart,
};
use crate::{
    ground::Ground,
    scatter::plan::{
        forest::{ForestPlan, MOST_SPECIES},
        keep_out::{Blocker, KeepOut},
        stock::Stock,
    },
    setting::{SettingError, require},
};

/// Most candidates of a cell, where very many areas overlap.
const MOST_CANDIDATES: usize = 1 << 22;

/// Plants of one species that are to be expected at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ExpectedStock {
    /// Number of the species, as in [`Planted::species`].
    pub species: u8,
    /// Mean age.
    pub age_years: f32,
    pub density_per_ha: f32,
}

/// A plan, prepared for planting.
#[derive(Clone, Debug)]
pub struct Planter {
    cell_m: f64,
    species: Vec<String>,
    /// The first stock of each species.
    stocks: Vec<Stock>,
    layers: Vec<Layer>,
    /// Number of the species of each stock of each layer.
    species_of_stock: Vec<Vec<u8>>,
    layers_by_place: BoxIndex,
    blockers: Vec<Blocker>,
    blockers_by_place: BoxIndex,
    greatest_distance_m: f64,
}

impl Planter {
    /// Prepares a plan.
    ///
    /// # Errors
    /// [`SettingError`] where the plan is not valid or has more than 256 species.
    pub fn new(plan: &ForestPlan) -> Result<Self, SettingError> {
        plan.validate()?;
        // Areas where nothing grows still count, so that growing something there changes no other area.
        let layers: Vec<Layer> = plan
            .areas
            .iter()
            .zip(0..)
            .filter(|(area, _)| area.density_per_ha > 0.0)
            .map(|(area, number)| Layer::new(area, number, plan.seed))
            .collect::<Result<_, _>>()?;
        let mut stocks: Vec<Stock> = Vec::new();
        let mut species_of_stock = Vec::with_capacity(layers.len());
        for layer in &layers {
            let mut numbers = Vec::with_capacity(layer.stocks().len());
            for stock in layer.stocks() {
                numbers.push(species_number(&mut stocks, stock)?);
            }
            species_of_stock.push(numbers);
        }
        for species in &plan.more_species {
            species_number(&mut stocks, &Stock { species: species.clone(), ..Stock::default() })?;
        }
        let blockers: Vec<Blocker> = plan.keep_out.iter().flat_map(KeepOut::blockers).collect();
        Ok(Self {
            cell_m: f64::from(plan.cell_m),
            species: stocks.iter().map(|stock| stock.species.clone()).collect(),
            stocks,
            layers_by_place: BoxIndex::new(layers.iter().map(Layer::bounds)),
            blockers_by_place: BoxIndex::new(blockers.iter().map(Blocker::bounds)),
            greatest_distance_m: layers.iter().map(Layer::least_distance_m).fold(0.0, f64::max),
            layers,
            species_of_stock,
            blockers,
        })
    }

    /// The names of the species, in the order of [`Planted::species`].
    pub fn species(&self) -> &[String] {
        &self.species
    }

    /// Side of a cell, m.
    pub fn cell_m(&self) -> f32 {
        self.cell_m as f32
    }

    /// The least corner (x, z) of a cell, m.
    pub(crate) fn corner_m(&self, cell: IVec2) -> DVec2 {
        cell.as_dvec2() * self.cell_m
    }

    /// The cell at a place (x, z), m.
    pub(crate) fn cell_at(&self, place_m: Vec2) -> IVec2 {
        (place_m.as_dvec2() / self.cell_m).floor().as_ivec2()
    }

    /// The least and the greatest cell that may hold plants; `None` where nothing grows.
    pub fn cells(&self) -> Option<[IVec2; 2]> {
        let boxes = self.layers.iter().map(Layer::bounds);
        let [min, max] = boxes.reduce(|[min, max], other| [min.min(other[0]), max.max(other[1])])?;
        Some([min, max].map(|corner| self.cell_at(corner.as_vec2())))
    }

    /// Plants per hectare to be expected at a place (x, z), before those go that are too near to each other; 0 where
    /// nothing may grow.
    pub(crate) fn density_per_ha(&self, at: DVec2, ground: &impl Ground) -> f32 {
        let mut density_per_ha = 0.0;
        self.visit_layers(at, ground, |_, layer, height_m, slope| {
            density_per_ha += layer.density_per_ha(at, height_m, slope);
        });
        density_per_ha
    }

    /// Tells what stock is to be expected at a place (x, z), as [`density_per_ha`](Self::density_per_ha) counts it.
    pub(crate) fn expected_stock(&self, at: DVec2, ground: &impl Ground, mut tell: impl FnMut(ExpectedStock)) {
        self.visit_layers(at, ground, |number, layer, height_m, slope| {
            layer.expected_stock(at, height_m, slope, |stock, density_per_ha| {
                let species = self.species_of_stock[number][stock as usize];
                tell(ExpectedStock { species, age_years: layer.stock(stock).age_years, density_per_ha });
            });
        });
    }

    /// Visits the layers that may grow at a place (x, z) where nothing is in the way, with the height and the slope of the ground.
    fn visit_layers(&self, at: DVec2, ground: &impl Ground, mut visit: impl FnMut(usize, &Layer, f32, f32)) {
        let mut near = Vec::new();
        self.blockers_by_place.near(at, at, &mut near);
        if near.iter().any(|&number| self.blockers[number as usize].covers(at)) {
            return;
        }
        let (height_m, slope) = (ground.height_m(at) as f32, ground.slope(at) as f32);
        if !height_m.is_finite() {
            return;
        }
        self.layers_by_place.near(at, at, &mut near);
        for number in near.into_iter().map(|number| number as usize) {
            visit(number, &self.layers[number], height_m, slope);
        }
    }

    /// Fills `planted` with what stands in a cell: the same whatever was planted before. Plants near the border are compared
    /// with those of other cells, so `ground` is asked about places as far outside the cell as the greatest least distance.
    pub fn plant(&self, cell: IVec2, ground: &impl Ground, planted: &mut Vec<Planted>) {
        planted.clear();
        let corner = self.corner_m(cell);
        let cell = Square { min: corner, max: corner + self.cell_m };
        let around = Square { min: cell.min - self.greatest_distance_m, max: cell.max + self.greatest_distance_m };
        let mut near = Vec::new();
        self.blockers_by_place.near(around.min, around.max, &mut near);
        let blockers: Vec<&Blocker> = near.iter().map(|&number| &self.blockers[number as usize]).collect();
        let free = |at: DVec2| !blockers.iter().any(|blocker| blocker.covers(at));
        self.layers_by_place.near(around.min, around.max, &mut near);

        let (mut places, mut candidates) = (Vec::new(), Vec::new());
        for (order, &number) in near.iter().enumerate() {
            // Every area has room for some plants, however many crowd into the earlier ones.
            let most = MOST_CANDIDATES / near.len() * (order + 1);
            self.layers[number as usize].add_candidates(around, cell, ground, free, &mut places, &mut candidates, most);
        }
        keep_apart(&mut candidates, self.greatest_distance_m);
        planted.extend(candidates.iter().filter(|one| one.in_cell && one.stays).map(|one| self.grow(one)));
    }

    /// A single plant at a place: its size, season and tint follow from `seed`, in the manner of the plan's first stock of its species.
    /// None of a species that the plan does not have.
    pub(crate) fn plant_one(&self, position: Vec3, species: u8, age_years: f32, seed: u64) -> Option<Planted> {
        let stock = self.stocks.get(usize::from(species))?;
        let stock = Stock { age_years, age_spread_years: 0.0, ..stock.clone() };
        Some(Planted::grow(position, &stock, species, seed))
    }

    /// A plant as it would be at another age, and of another species, if the plan has that. Its size in stores is that of the plan's first
    /// stock of the species.
    pub(crate) fn altered(&self, plant: Planted, species: u8, age_years: f32) -> Planted {
        let Some(stock) = self.stocks.get(usize::from(species)) else { return plant };
        Planted { species, ..plant.at_age(age_years, stock.full_grown_years) }
    }

    fn grow(&self, candidate: &Candidate) -> Planted {
        let layer = self.layers.partition_point(|layer| layer.number() < candidate.area);
        let place = candidate.at.as_vec2();
        Planted::grow(
            Vec3::new(place.x, candidate.height_m, place.y),
            self.layers[layer].stock(candidate.stock),
            self.species_of_stock[layer][candidate.stock as usize],
            candidate.seed,
        )
    }
}

/// The number of a stock's species, which is added where it is new.
fn species_number(stocks: &mut Vec<Stock>, stock: &Stock) -> Result<u8, SettingError> {
    let number = stocks.iter().position(|other| other.species == stock.species).unwrap_or(stocks.len());
    require("species.len()", number + 1, 1..=MOST_SPECIES)?;
    if number == stocks.len() {
        stocks.push(stock.clone());
    }
    Ok(number as u8)
}

#[cfg(test)]
mod tests;
