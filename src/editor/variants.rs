//! Changes that reflection cannot make by itself: variants that hold settings, and the lengths of lists.

use bevy::reflect::{GetPath, PartialReflect, Reflect, ReflectMut, enums::Enum};

use super::{document::Document, fields::copy_at};

/// Settings whose enum at a path has another variant, with its default settings. None where there is no such variant.
pub fn with_variant<T: Document>(settings: &T, path: &str, variant: &str) -> Option<T> {
    let mut changed = settings.clone();
    let value = changed.reflect_path_mut(path).ok()?;
    T::choose(value, variant).then_some(changed)
}

/// Gives a value the variant of that name, if it is of this type.
pub fn choose_of<T: Reflect + Enum>(
    value: &mut dyn PartialReflect,
    all: impl IntoIterator<Item = T>,
    variant: &str,
) -> bool {
    let Some(own) = value.try_downcast_mut::<T>() else { return false };
    let chosen = all.into_iter().find(|one| one.variant_name() == variant);
    chosen.map(|chosen| *own = chosen).is_some()
}

/// Settings whose list at a path has one more item like the last, or one less. None where it cannot.
pub fn with_list<T: Document>(settings: &T, path: &str, is_longer: bool) -> Option<T> {
    with_list_of(settings, &settings.default_of_kind(), path, is_longer)
}

/// The same of any settings. An empty list gets the items of the default.
pub fn with_list_of<T: Reflect + Clone>(settings: &T, default: &T, path: &str, is_longer: bool) -> Option<T> {
    let mut changed = settings.clone();
    let ReflectMut::List(list) = changed.reflect_path_mut(path).ok()?.reflect_mut() else { return None };
    if is_longer {
        match list.get(list.len().saturating_sub(1)).map(PartialReflect::to_dynamic) {
            Some(last) => list.push(last.ok()?),
            None => return copy_at(&mut changed, default, path).then_some(changed),
        }
    } else {
        list.pop()?;
    }
    Some(changed)
}
