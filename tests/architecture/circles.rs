//! Circles in a graph: its strongly connected components of more than one node (Tarjan 1972).

use std::collections::{BTreeMap, BTreeSet};

/// Files that all import one another, by way of others or not.
#[derive(Debug, PartialEq, Eq)]
pub struct Circle {
    /// The files, sorted.
    pub files: Vec<String>,
    /// The imports among them, sorted.
    pub arrows: Vec<(String, String)>,
}

struct Search<'a> {
    edges: &'a BTreeMap<String, BTreeSet<String>>,
    /// Order in which nodes were reached, and the earliest that each leads back to.
    reached: BTreeMap<&'a str, usize>,
    earliest: BTreeMap<&'a str, usize>,
    open: Vec<&'a str>,
    found: Vec<Vec<&'a str>>,
}

impl<'a> Search<'a> {
    fn visit(&mut self, node: &'a str) {
        let order = self.reached.len();
        self.reached.insert(node, order);
        self.earliest.insert(node, order);
        self.open.push(node);
        let edges = self.edges;
        for other in edges.get(node).into_iter().flatten() {
            if !self.reached.contains_key(other.as_str()) {
                self.visit(other);
            }
            if self.open.contains(&other.as_str()) {
                let earliest = self.earliest[node].min(self.earliest[other.as_str()]);
                self.earliest.insert(node, earliest);
            }
        }
        if self.earliest[node] == order {
            let start = self.open.iter().position(|&open| open == node).expect("the node is open");
            self.found.push(self.open.split_off(start));
        }
    }
}

/// All circles of the graph, each with its arrows.
pub fn circles(edges: &BTreeMap<String, BTreeSet<String>>) -> Vec<Circle> {
    let (reached, earliest) = (BTreeMap::new(), BTreeMap::new());
    let mut search = Search { edges, reached, earliest, open: Vec::new(), found: Vec::new() };
    for node in edges.keys() {
        if !search.reached.contains_key(node.as_str()) {
            search.visit(node);
        }
    }
    let circles = search.found.iter().filter(|files| files.len() > 1);
    circles
        .map(|files| {
            let mut files: Vec<String> = files.iter().map(ToString::to_string).collect();
            files.sort();
            let from = |file: &String| {
                let others = edges[file].iter().filter(|other| files.contains(other));
                others.map(|other| (file.clone(), other.clone())).collect::<Vec<_>>()
            };
            let arrows = files.iter().flat_map(from).collect();
            Circle { files, arrows }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph(edges: &[(&str, &[&str])]) -> BTreeMap<String, BTreeSet<String>> {
        let owned = edges.iter().map(|(from, to)| (from.to_string(), to.iter().map(ToString::to_string).collect()));
        owned.collect()
    }

    #[test]
    fn a_graph_without_circles_has_none() {
        assert!(circles(&graph(&[("a", &["b", "c"]), ("b", &["c"]), ("c", &[])])).is_empty());
    }

    #[test]
    fn two_circles_are_told_apart_with_their_arrows() {
        let found = circles(&graph(&[("a", &["b", "c"]), ("b", &["a"]), ("c", &["d"]), ("d", &["e"]), ("e", &["c"])]));
        let files: Vec<Vec<String>> = found.iter().map(|circle| circle.files.clone()).collect();
        assert_eq!(files, [vec!["c", "d", "e"], vec!["a", "b"]]);
        assert_eq!(found[1].arrows, [("a".into(), "b".into()), ("b".into(), "a".into())]);
    }
}
