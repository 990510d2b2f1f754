//! The chosen area's mask as a picture in a file of its own.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::Woods;
use crate::{
    editor::{document_file::FileError, file_session::Message},
    file_write::replace_file,
    scatter::plan::{
        Place, Shape,
        mask_image::{MaskImageError, mask_of_png, png_of_mask},
    },
};

impl Woods {
    /// Saves the chosen area's mask as a PNG. Nothing where it is no mask.
    pub fn save_mask(&mut self) {
        let Some(Shape::Mask { rows, .. }) = self.chosen_shape() else { return };
        let path = self.mask_png();
        let saved = write(&path, rows);
        self.tell_of_mask(saved, format!("Saved {}", path.display()));
    }

    /// Makes the chosen area the mask of a PNG, over the bounds that it has. What cannot be read leaves it as it is.
    pub fn load_mask(&mut self) {
        let Some(number) = self.chosen_area() else { return };
        let Some([min_m, max_m]) = self.chosen_bounds_m() else {
            self.mask_error = Some("An outline that is not valid has no bounds: correct it first".to_owned());
            return;
        };
        let path = self.mask_png();
        let loaded = read(&path).map(|rows| {
            let mut plan = self.plan().clone();
            plan.areas[number].shape = Shape::Mask { min_m, max_m, rows };
            self.corner = None;
            self.step(plan, "Load a mask");
        });
        self.tell_of_mask(loaded, format!("Loaded {}", path.display()));
    }

    fn chosen_shape(&self) -> Option<&Shape> {
        let number = self.chosen_area()?;
        self.plan().areas.get(number).map(|area| &area.shape)
    }

    /// The rectangle around the chosen area, m. Only a valid polygon has one.
    fn chosen_bounds_m(&self) -> Option<[Place; 2]> {
        match self.chosen_shape()? {
            Shape::Rectangle { min_m, max_m } | Shape::Mask { min_m, max_m, .. } => Some([*min_m, *max_m]),
            polygon @ Shape::Polygon { .. } => self.plan().validate().is_ok().then(|| polygon.bounds_m()),
        }
    }

    /// The path that was typed. It ends in `.png`, so that no plan is ever overwritten by a picture.
    fn mask_png(&self) -> PathBuf {
        let typed = self.mask_path.trim();
        let is_png = Path::new(typed).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
        PathBuf::from(if is_png { typed.to_owned() } else { format!("{typed}.png") })
    }

    fn tell_of_mask(&mut self, result: Result<(), FileError>, done: String) {
        self.mask_error = result.err().map(|error| error.to_string());
        if self.mask_error.is_none() {
            self.session.message = Some(Message::Done(done));
        }
    }
}

fn write(path: &Path, rows: &[String]) -> Result<(), FileError> {
    let png = png_of_mask(rows).map_err(|error| content(path, &error))?;
    replace_file(path, &png).map_err(|error| FileError::Disk { path: path.to_owned(), error })
}

fn read(path: &Path) -> Result<Vec<String>, FileError> {
    let bytes = fs::read(path).map_err(|error| FileError::Disk { path: path.to_owned(), error })?;
    mask_of_png(&bytes).map_err(|error| content(path, &error))
}

fn content(path: &Path, error: &MaskImageError) -> FileError {
    FileError::Content { path: path.to_owned(), error: error.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        editor::{plan_element::Element, session::Session, steps::Steps},
        scatter::ForestPlan,
    };

    #[test]
    fn any_area_becomes_the_mask_of_a_picture_over_its_bounds_in_one_step() {
        let folder = tempfile::tempdir().unwrap();
        let mixed = include_str!("../../../assets/forests/mixed.forest.ron");
        let plan = ForestPlan::from_ron(mixed).unwrap();
        let mut woods = Woods::new(Session::new(Path::new("mixed.forest.ron"), plan.clone()));
        woods.mask_path = folder.path().join("density").display().to_string();
        woods.choose(Element::Area(0));
        woods.save_mask();
        assert!(!folder.path().join("density.png").exists(), "a polygon is no mask");
        woods.load_mask();
        assert!(woods.mask_error.as_ref().is_some_and(|error| error.contains("density.png")), "{:?}", woods.mask_error);
        assert_eq!(*woods.plan(), plan);
        let rows = vec![".59".to_owned(), "9.1".to_owned()];
        fs::write(folder.path().join("density.png"), png_of_mask(&rows).unwrap()).unwrap();
        woods.load_mask();
        let [min_m, max_m] = plan.areas[0].shape.bounds_m();
        assert_eq!(woods.plan().areas[0].shape, Shape::Mask { min_m, max_m, rows });
        assert_eq!((&woods.mask_error, woods.session.undo_step()), (&None, Some("Load a mask")));
        woods.session.undo();
        assert_eq!(*woods.plan(), plan);
    }
}
