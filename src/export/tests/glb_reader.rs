//! A GLB, opened by the crate `gltf`, which checks it against the schema.

use bevy::math::{Mat4, Quat, Vec3};
use gltf::{Accessor, Gltf, Node, Primitive, animation::util::ReadOutputs};

pub struct Reader {
    pub gltf: Gltf,
}

/// The keys of a joint.
#[derive(Default)]
pub struct Keys {
    pub times_s: Vec<f32>,
    pub rotations: Vec<Quat>,
    pub translations: Vec<Vec3>,
}

impl Reader {
    pub fn new(glb: &[u8]) -> Self {
        Self { gltf: Gltf::from_slice(glb).expect("it is valid") }
    }

    pub fn blob(&self) -> &[u8] {
        self.gltf.blob.as_deref().expect("the buffer is in the file")
    }

    /// The bytes of an accessor, tightly packed.
    pub fn bytes(&self, accessor: &Accessor) -> &[u8] {
        let view = accessor.view().expect("no accessor is sparse");
        let first = view.offset() + accessor.offset();
        &self.blob()[first..first + accessor.count() * accessor.size()]
    }

    pub fn node(&self, name: &str) -> Node<'_> {
        self.gltf.nodes().find(|node| node.name() == Some(name)).unwrap_or_else(|| panic!("no node is called {name}"))
    }

    /// The primitive with a material whose name ends so.
    pub fn primitive(&self, node: &str, material: &str) -> Option<Primitive<'_>> {
        let mesh = self.node(node).mesh().expect("it has a mesh");
        mesh.primitives().find(|primitive| primitive.material().name().unwrap().ends_with(material))
    }

    pub fn positions(&self, primitive: &Primitive) -> Vec<[f32; 3]> {
        primitive.reader(|_| Some(self.blob())).read_positions().unwrap().collect()
    }

    pub fn indices(&self, primitive: &Primitive) -> Vec<u32> {
        primitive.reader(|_| Some(self.blob())).read_indices().unwrap().into_u32().collect()
    }

    /// Joints and weights of each vertex.
    pub fn influences(&self, primitive: &Primitive) -> Vec<[(usize, f32); 4]> {
        let reader = primitive.reader(|_| Some(self.blob()));
        let joints = reader.read_joints(0).unwrap().into_u16();
        let weights = reader.read_weights(0).unwrap().into_f32();
        joints
            .zip(weights)
            .map(|(joints, weights)| std::array::from_fn(|slot| (usize::from(joints[slot]), weights[slot])))
            .collect()
    }

    /// The joints of the only skin with their parents among them.
    pub fn joints(&self) -> Vec<(Node<'_>, Option<usize>)> {
        let joints: Vec<Node> = self.gltf.skins().next().expect("it has a skin").joints().collect();
        let parent =
            |child: &Node| joints.iter().position(|joint| joint.children().any(|other| other.index() == child.index()));
        joints.iter().map(|joint| (joint.clone(), parent(joint))).collect()
    }

    pub fn inverse_binds(&self) -> Vec<Mat4> {
        let skin = self.gltf.skins().next().unwrap();
        let matrices = skin.reader(|_| Some(self.blob())).read_inverse_bind_matrices().unwrap();
        matrices.map(|matrix| Mat4::from_cols_array_2d(&matrix)).collect()
    }

    /// The keys of each joint, in the order of the skin.
    pub fn keys(&self) -> Vec<Keys> {
        let joints = self.joints();
        let mut keys: Vec<Keys> = joints.iter().map(|_| Keys::default()).collect();
        for channel in self.gltf.animations().next().expect("it moves").channels() {
            let joint = joints.iter().position(|(joint, _)| joint.index() == channel.target().node().index()).unwrap();
            let reader = channel.reader(|_| Some(self.blob()));
            keys[joint].times_s = reader.read_inputs().unwrap().collect();
            match reader.read_outputs().unwrap() {
                ReadOutputs::Rotations(turns) => {
                    keys[joint].rotations = turns.into_f32().map(Quat::from_array).collect();
                }
                ReadOutputs::Translations(ways) => keys[joint].translations = ways.map(Vec3::from_array).collect(),
                _ => panic!("joints turn and move, and nothing else"),
            }
        }
        keys
    }

    /// The matrices of the joints at a time, interpolated as players do it.
    pub fn joint_matrices(&self, keys: &[Keys], time_s: f32) -> Vec<Mat4> {
        let mut matrices: Vec<Mat4> = Vec::new();
        for ((joint, parent), keys) in self.joints().iter().zip(keys) {
            let local = match keys.times_s.partition_point(|time| *time <= time_s) {
                _ if keys.times_s.is_empty() => Mat4::from_cols_array_2d(&joint.transform().matrix()),
                next => {
                    let next = next.clamp(1, keys.times_s.len() - 1);
                    let [from, to] = [keys.times_s[next - 1], keys.times_s[next]];
                    let share = (time_s - from) / (to - from);
                    let turn = keys.rotations[next - 1].slerp(keys.rotations[next], share);
                    let way = keys.translations[next - 1].lerp(keys.translations[next], share);
                    Mat4::from_rotation_translation(turn, way)
                }
            };
            matrices.push(parent.map_or(local, |parent| matrices[parent] * local));
        }
        matrices
    }
}
