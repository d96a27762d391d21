// The elements of a file, one function each. What is said of a geom and of a site stands in
// read_shape.
#include "runtime/mjcf/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <numbers>
#include <set>

#include "runtime/base/printable.h"
#include "runtime/mjcf/schema.h"
#include "runtime/mjcf/values.h"

namespace probe::mjcf {
namespace {

namespace fs = std::filesystem;

// More than a kitchen with a robot has; what is made of each takes kilobytes, and some is compared
// each with each.
constexpr std::size_t kMostBodies = 2048, kMostGeoms = 4096, kMostSites = 4096, kMostJoints = 4096,
                      kMostLights = 1024, kMostCameras = 1024, kMostMeshes = 2048,
                      kMostTextures = 1024, kMostMaterials = 2048;

constexpr Rgba kUnsaidRgba{0.5, 0.5, 0.5, 1};

struct ShapeWord {
  std::string_view word;
  Shape shape;
  std::size_t sizes;  // that have to be said
};
constexpr auto kShapes = std::to_array<ShapeWord>({{"plane", Shape::kPlane, 2},
                                                   {"sphere", Shape::kSphere, 1},
                                                   {"capsule", Shape::kCapsule, 2},
                                                   {"ellipsoid", Shape::kEllipsoid, 3},
                                                   {"cylinder", Shape::kCylinder, 2},
                                                   {"box", Shape::kBox, 3},
                                                   {"mesh", Shape::kMesh, 0}});

// Along its z by two points: the sizes across it are said, one or two.
bool is_long(Shape shape) {
  return shape == Shape::kCapsule || shape == Shape::kCylinder || shape == Shape::kEllipsoid ||
         shape == Shape::kBox;
}

class ModelReader {
 public:
  ModelReader(const Document& document, const Classes& classes, bool merged)
      : document_(document), classes_(classes), merged_(merged) {
    folder_ = fs::path(document.files.front()).parent_path();
  }

  Result<Model> read(const Compiler* given) {
    model_.files = document_.files;
    if (const std::string* name = document_.root.find("model")) model_.name = *name;
    PROBE_TRY(check_sections());
    if (given != nullptr) model_.compiler = *given;
    for (const Element& section : document_.root.children) {
      if (section.tag != "compiler") continue;
      PROBE_TRY(check_leaf(section));
      if (given == nullptr) PROBE_TRY(read_compiler(section));
    }
    for (const Element& section : document_.root.children) {
      if (section.tag == "asset") PROBE_TRY(read_assets(section));
    }
    PROBE_TRY(link_assets());
    Body world;
    world.name = "world";
    world.at = document_.root.at;
    model_.bodies.push_back(std::move(world));
    for (const Element& section : document_.root.children) {
      if (section.tag != "worldbody") continue;
      PROBE_TRY(check_attributes(section));
      PROBE_TRY(read_content(section, 0, "main", Pose{}));
    }
    return std::move(model_);
  }

  Status read_compiler(const Element& element) {
    const Values values(document_, element);
    Compiler& c = model_.compiler;
    constexpr std::string_view kAngles[] = {"radian", "degree"};
    std::size_t angle = c.degrees ? 1 : 0;
    PROBE_TRY(values.read_word("angle", kAngles, angle));
    c.degrees = angle == 1;
    PROBE_TRY(values.read("autolimits", c.autolimits));
    if (const auto seq = values.find("eulerseq")) {
      const auto is_axis = [](char a) {
        return std::string_view("xyzXYZ").find(a) != std::string_view::npos;
      };
      if (seq->text.size() != 3 || !std::ranges::all_of(seq->text, is_axis))
        return values.fail("`eulerseq` is three of x, y, z, X, Y and Z");
      c.eulerseq = seq->text;
    }
    PROBE_TRY(values.read("assetdir", c.meshdir));
    PROBE_TRY(values.read("assetdir", c.texturedir));
    PROBE_TRY(values.read("meshdir", c.meshdir));
    PROBE_TRY(values.read("texturedir", c.texturedir));
    PROBE_TRY(values.read("strippath", c.strippath));
    constexpr std::string_view kFrom[] = {"false", "true", "auto"};
    auto from = static_cast<std::size_t>(c.inertia_from_geom);
    PROBE_TRY(values.read_word("inertiafromgeom", kFrom, from));
    c.inertia_from_geom = static_cast<Compiler::FromGeom>(from);
    double groups[2] = {static_cast<double>(c.first_group), static_cast<double>(c.last_group)};
    PROBE_TRY(values.read("inertiagrouprange", groups, 2));
    c.first_group = static_cast<int>(std::clamp(groups[0], -1e6, 1e6));
    c.last_group = static_cast<int>(std::clamp(groups[1], -1e6, 1e6));
    PROBE_TRY(values.read("exactmeshinertia", c.exact_mesh_inertia));
    PROBE_TRY(values.read_not_negative("boundmass", c.bound_mass));
    PROBE_TRY(values.read_not_negative("boundinertia", c.bound_inertia));
    constexpr std::string_view kLocal[] = {"local"};
    std::size_t local = 0;
    return values.read_word("coordinate", kLocal, local);
  }

  const Compiler& compiler() const { return model_.compiler; }

 private:
  void note(const At& at, std::string text) { model_.notes.push_back({at, std::move(text)}); }

  Failure fail(const At& at, std::string message) const {
    return {Fault::kAsset, std::move(message), document_.where(at)};
  }

  // One more of what there may be so many of.
  Status count(std::size_t& counted, std::size_t most, const char* what, const Element& element) {
    if (++counted <= most) return {};
    return fail(element.at, fmt::format("more than {} {}", most, what));
  }

  Failure unknown(const Element& element, const char* within) const {
    return fail(element.at,
                fmt::format("`{}` is no element of {}", printable(element.tag, 60), within));
  }

  // Every element of a class, too: a slip in one of those is as wrong.
  Status check_class(const Element& element) {
    PROBE_TRY(check_attributes(element));
    for (const Element& child : element.children) {
      if (child.tag == "default") {
        PROBE_TRY(check_class(child));
        continue;
      }
      constexpr std::string_view kRead = "geom site joint camera light mesh material texture";
      if (has_word(kRead, child.tag)) {
        PROBE_TRY(check_leaf(child));
      } else if (is_unread_in_default(child.tag)) {
        note(child.at, fmt::format("`{}` of a class is not read", child.tag));
      } else {
        return unknown(child, "a class");
      }
    }
    return {};
  }

  // Attributes, and that nothing stands in an element that holds nothing.
  Status check_leaf(const Element& element) {
    PROBE_TRY(check_attributes(element));
    for (const Element& child : element.children) {
      if (!has_word(find_schema(element.tag)->children, child.tag))
        return unknown(child, ("`" + element.tag + "`").c_str());
      note(child.at, fmt::format("`{}` of `{}` is not read", child.tag, element.tag));
    }
    return {};
  }

  Status check_sections() {
    for (const Element& section : document_.root.children) {
      if (section.tag == "default") {
        PROBE_TRY(check_class(section));
      } else if (section.tag != "compiler" && section.tag != "asset" &&
                 section.tag != "worldbody") {
        if (!is_unread_section(section.tag)) return unknown(section, "`mujoco`");
        // `size` is room for the engine.
        if (section.tag != "size" && (!section.children.empty() || !section.attributes.empty()))
          note(section.at, fmt::format("`{}` is not read", section.tag));
      }
    }
    return {};
  }

  Status check_attributes(const Element& element) {
    const ElementSchema* schema = find_schema(element.tag);
    for (const auto& [name, value] : element.attributes) {
      if (has_word(schema->read, name) || has_word(schema->silent, name)) continue;
      if (!has_word(schema->unread, name))
        return fail(element.at,
                    fmt::format("`{}` has no attribute `{}`", element.tag, printable(name, 60)));
      note(element.at, fmt::format("`{}` of `{}` is not read", name, element.tag));
    }
    return {};
  }

  // An element over its class; the class of those around it unless it says one.
  Result<Values> values_of(const Element& element, std::string_view childclass) {
    PROBE_TRY(check_leaf(element));
    std::string_view name = childclass;
    if (const std::string* said = element.find("class")) {
      if (!classes_.has(*said))
        return fail(element.at, "there is no class `" + printable(*said, 60) + "`");
      name = *said;
    }
    return Values(document_, element, classes_.of(name, element.tag));
  }

  // ---- assets

  std::string path_of(const std::string& dir, const std::string& written) const {
    const std::string file =
        model_.compiler.strippath ? fs::path(written).filename().string() : written;
    return (folder_ / (merged_ ? "" : dir) / file).lexically_normal().string();
  }

  // Whether it is new: of two of one name the first counts.
  template <typename Asset>
  bool is_first(const std::vector<Asset>& known, const std::string& name, const Element& element) {
    const auto other = std::ranges::find(known, name, &Asset::name);
    if (other == known.end()) return true;
    note(element.at, fmt::format("a second {} `{}`: the one of {} counts", element.tag,
                                 printable(name, 60), document_.where(other->at)));
    return false;
  }

  Status read_assets(const Element& section) {
    PROBE_TRY(check_attributes(section));
    for (const Element& element : section.children) {
      if (element.tag == "texture") {
        PROBE_TRY(read_texture(element));
      } else if (element.tag == "material") {
        PROBE_TRY(read_material(element));
      } else if (element.tag == "mesh") {
        PROBE_TRY(read_mesh(element));
      } else if (is_unread_asset(element.tag)) {
        note(element.at, fmt::format("`{}` is not read", element.tag));
      } else {
        return unknown(element, "`asset`");
      }
    }
    return {};
  }

  Status read_mesh(const Element& element) {
    PROBE_TRY(count(meshes_, kMostMeshes, "meshes", element));
    PROBE_ASSIGN(const Values values, values_of(element, "main"));
    MeshAsset mesh;
    mesh.at = element.at;
    std::string file;
    PROBE_TRY(values.read("file", file));
    if (file.empty()) return fail(element.at, "a mesh without `file`, which is not read");
    mesh.file = path_of(model_.compiler.meshdir, file);
    mesh.name = fs::path(file).stem().string();
    PROBE_TRY(values.read("name", mesh.name));
    PROBE_TRY(values.read("scale", mesh.scale));
    if ((mesh.scale.array() == 0).any()) return fail(element.at, "a mesh with a scale of 0");
    PROBE_TRY(values.read("refpos", mesh.origin));
    double q[4] = {1, 0, 0, 0};
    PROBE_TRY(values.read("refquat", q, 4));
    const Quat turn(q[0], q[1], q[2], q[3]);
    if (!(turn.norm() > 1e-15)) return fail(element.at, "`refquat` of no length");
    mesh.turn = turn.normalized();
    constexpr std::string_view kWords[] = {"legacy", "shell", "exact", "convex"};
    std::size_t which = 0;
    PROBE_TRY(values.read_word("inertia", kWords, which));
    if (which == 1) mesh.inertia = MeshAsset::Inertia::kShell;
    if (which > 1) note(element.at, "`inertia` of `mesh` is taken as `legacy`");
    if (is_first(model_.meshes, mesh.name, element)) model_.meshes.push_back(std::move(mesh));
    return {};
  }

  Status read_texture(const Element& element) {
    PROBE_TRY(count(textures_, kMostTextures, "textures", element));
    PROBE_ASSIGN(const Values values, values_of(element, "main"));
    Texture texture;
    texture.at = element.at;
    constexpr std::string_view kTypes[] = {"2d", "cube", "skybox"};
    auto type = static_cast<std::size_t>(texture.type);
    PROBE_TRY(values.read_word("type", kTypes, type));
    texture.type = static_cast<Texture::Type>(type);
    constexpr std::string_view kBuiltins[] = {"none", "gradient", "checker", "flat"};
    std::size_t builtin = 0;
    PROBE_TRY(values.read_word("builtin", kBuiltins, builtin));
    texture.builtin = static_cast<Texture::Builtin>(builtin);
    PROBE_TRY(values.read("rgb1", texture.rgb1, 3));
    PROBE_TRY(values.read("rgb2", texture.rgb2, 3));
    PROBE_TRY(values.read("width", texture.width));
    PROBE_TRY(values.read("height", texture.height));
    PROBE_TRY(values.read("hflip", texture.flip_across));
    PROBE_TRY(values.read("vflip", texture.flip_down));
    const auto read_file = [&](std::string_view name, std::string& to) -> Status {
      std::string file;
      PROBE_TRY(values.read(name, file));
      if (!file.empty()) to = path_of(model_.compiler.texturedir, file);
      return {};
    };
    PROBE_TRY(read_file("file", texture.file));
    constexpr std::string_view kFaces[] = {"fileright", "fileleft",  "fileup",
                                           "filedown",  "filefront", "fileback"};
    bool has_faces = false;
    for (std::size_t i = 0; i < 6; ++i) {
      PROBE_TRY(read_file(kFaces[i], texture.faces[i]));
      has_faces = has_faces || !texture.faces[i].empty();
    }
    if (texture.builtin != Texture::Builtin::kFile &&
        (texture.width < 1 || texture.height < 1 || texture.width > 8192 || texture.height > 65536))
      return fail(element.at,
                  "a builtin texture wants a `width` and a `height` of 1 to 8192 pixels");
    if (texture.builtin == Texture::Builtin::kFile && texture.file.empty() && !has_faces)
      return fail(element.at, "a texture without `file` and without `builtin`");
    if (!texture.file.empty()) texture.name = fs::path(texture.file).stem().string();
    PROBE_TRY(values.read("name", texture.name));
    if (texture.name.empty() && texture.type != Texture::Type::kSkybox)
      return fail(element.at, "a texture without a name");
    if (is_first(model_.textures, texture.name, element))
      model_.textures.push_back(std::move(texture));
    return {};
  }

  Status read_material(const Element& element) {
    PROBE_TRY(count(materials_, kMostMaterials, "materials", element));
    PROBE_ASSIGN(const Values values, values_of(element, "main"));
    Material material;
    material.at = element.at;
    PROBE_TRY(values.read("name", material.name));
    if (material.name.empty()) return fail(element.at, "a material without a name");
    PROBE_TRY(values.read("texrepeat", material.repeat, 1));
    PROBE_TRY(values.read("texuniform", material.uniform));
    PROBE_TRY(values.read_not_negative("emission", material.emission));
    PROBE_TRY(values.read_not_negative("specular", material.specular));
    PROBE_TRY(values.read_not_negative("shininess", material.shininess));
    PROBE_TRY(values.read_not_negative("reflectance", material.reflectance));
    PROBE_TRY(read_rgba(values, material.rgba));
    std::string texture;
    PROBE_TRY(values.read("texture", texture));
    if (!is_first(model_.materials, material.name, element)) return {};
    textures_of_.push_back(std::move(texture));
    model_.materials.push_back(std::move(material));
    return {};
  }

  Status read_rgba(const Values& values, Rgba& rgba) {
    PROBE_TRY(values.read("rgba", rgba, 3));
    for (double& channel : rgba) {
      if (channel < 0 || channel > 1)
        return values.fail("`rgba` has a number that is not from 0 to 1");
    }
    return {};
  }

  // Materials may stand before their textures.
  Status link_assets() {
    for (std::size_t i = 0; i < textures_of_.size(); ++i) {
      if (textures_of_[i].empty()) continue;
      Material& material = model_.materials[i];
      PROBE_ASSIGN(material.texture,
                   index_of(model_.textures, textures_of_[i], "texture", material.at));
    }
    return {};
  }

  template <typename Asset>
  Result<int> index_of(const std::vector<Asset>& all, const std::string& name, const char* kind,
                       const At& at) const {
    const auto found = std::ranges::find(all, name, &Asset::name);
    if (found != all.end()) return static_cast<int>(found - all.begin());
    return fail(at, fmt::format("there is no {} `{}`", kind, printable(name, 60)));
  }

  // ---- bodies

  // What stands in a body or in the world; `frame` is of the `frame` elements between.
  Status read_content(const Element& element, std::size_t body, std::string_view childclass,
                      const Pose& frame) {
    for (const Element& child : element.children) {
      if (child.tag == "body") {
        PROBE_TRY(read_body(child, body, childclass, frame));
      } else if (child.tag == "frame") {
        PROBE_TRY(check_attributes(child));
        const Values values(document_, child);
        PROBE_ASSIGN(const Pose pose, read_pose(values));
        PROBE_ASSIGN(const std::string_view of, childclass_of(child, childclass));
        PROBE_TRY(read_content(child, body, of, frame * pose));
      } else if (child.tag == "geom") {
        PROBE_TRY(read_geom(child, body, childclass, frame));
      } else if (child.tag == "site") {
        PROBE_TRY(read_site(child, body, childclass, frame));
      } else if (child.tag == "joint" || child.tag == "freejoint") {
        PROBE_TRY(read_joint(child, body, childclass, frame));
      } else if (child.tag == "inertial") {
        PROBE_TRY(read_inertial(child, body));
      } else if (child.tag == "camera") {
        PROBE_TRY(read_camera(child, body, childclass, frame));
      } else if (child.tag == "light") {
        PROBE_TRY(read_light(child, body, childclass, frame));
      } else if (is_unread_in_body(child.tag)) {
        note(child.at, fmt::format("`{}` is not read", child.tag));
      } else {
        return unknown(child, "a body");
      }
    }
    return {};
  }

  Result<std::string_view> childclass_of(const Element& element, std::string_view around) const {
    const std::string* said = element.find("childclass");
    if (said == nullptr) return around;
    if (!classes_.has(*said))
      return fail(element.at, "there is no class `" + printable(*said, 60) + "`");
    return std::string_view(*said);
  }

  Result<Pose> read_pose(const Values& values) {
    Pose pose;
    PROBE_TRY(values.read("pos", pose.position));
    PROBE_TRY(read_rotation(values, model_.compiler, pose.rotation));
    return pose;
  }

  Status read_body(const Element& element, std::size_t parent, std::string_view childclass,
                   const Pose& frame) {
    PROBE_TRY(count(bodies_, kMostBodies, "bodies", element));
    PROBE_TRY(check_attributes(element));
    const Values values(document_, element);
    Body body;
    body.at = element.at;
    body.parent = static_cast<int>(parent);
    PROBE_TRY(values.read("name", body.name));
    if (!body.name.empty() && (body.name == "world" || !body_names_.insert(body.name).second))
      return fail(element.at, "a second body `" + printable(body.name, 60) + "`");
    PROBE_ASSIGN(const Pose pose, read_pose(values));
    body.pose = frame * pose;
    PROBE_ASSIGN(const std::string_view of, childclass_of(element, childclass));
    model_.bodies.push_back(std::move(body));
    return read_content(element, model_.bodies.size() - 1, of, Pose{});
  }

  // Type, place and size, of a geom or a site. `said` is how many sizes are.
  template <typename Thing>
  Status read_shape(const Values& values, const Pose& frame, Thing& thing, std::size_t& said) {
    std::array<std::string_view, kShapes.size()> words;
    for (std::size_t i = 0; i < kShapes.size(); ++i) words[i] = kShapes[i].word;
    if (const auto type = values.find("type");
        type && (type->text == "hfield" || type->text == "sdf"))
      return values.fail(type->at, fmt::format("a geom of type `{}` is not read", type->text));
    std::size_t which = 1;
    PROBE_TRY(values.read_word("type", words, which));
    thing.shape = kShapes[which].shape;
    said = 0;
    PROBE_TRY(values.read("size", std::span<double>(thing.size.data(), 3), 1, &said));
    if (values.has("size") && (thing.size.head(static_cast<Eigen::Index>(said)).array() < 0).any())
      return values.fail(values.find("size")->at, "a size below 0");
    if (!values.has("fromto")) {
      PROBE_ASSIGN(const Pose pose, read_pose(values));
      thing.pose = frame * pose;
      return {};
    }
    double v[6] = {};
    PROBE_TRY(values.read("fromto", v, 6));
    if (!is_long(thing.shape))
      return values.fail("`fromto` is of capsules, cylinders, ellipsoids and boxes");
    const Vec3 from(v[0], v[1], v[2]), to(v[3], v[4], v[5]);
    const double length = (from - to).norm();
    if (!(length > 1e-15)) return values.fail("`fromto` has no length");
    thing.pose = frame * Pose{(from + to) / 2, turn_of_z((from - to) / length)};
    if (thing.shape == Shape::kCapsule || thing.shape == Shape::kCylinder) {
      thing.size[1] = length / 2;
      said = std::max<std::size_t>(said, said == 0 ? 0 : 2);
    } else {
      if (said < 2) thing.size[1] = thing.size[0];
      thing.size[2] = length / 2;
      said = said == 0 ? 0 : 3;
    }
    return {};
  }

  Status read_geom(const Element& element, std::size_t body, std::string_view childclass,
                   const Pose& frame) {
    PROBE_TRY(count(geoms_, kMostGeoms, "geoms", element));
    PROBE_ASSIGN(const Values values, values_of(element, childclass));
    Geom geom;
    geom.at = element.at;
    PROBE_TRY(values.read("name", geom.name));
    if (!geom.name.empty() && !geom_names_.insert(geom.name).second)
      note(element.at, "a second geom `" + printable(geom.name, 60) + "`");
    std::size_t said = 0;
    PROBE_TRY(read_shape(values, frame, geom, said));
    std::string mesh, material;
    PROBE_TRY(values.read("mesh", mesh));
    PROBE_TRY(values.read("material", material));
    if (!mesh.empty()) {
      PROBE_ASSIGN(geom.mesh, index_of(model_.meshes, mesh, "mesh", values.at()));
    }
    if (!material.empty()) {
      PROBE_ASSIGN(geom.material, index_of(model_.materials, material, "material", values.at()));
    }
    if ((geom.shape == Shape::kMesh) != (geom.mesh != kNone))
      return values.fail(geom.mesh == kNone ? "a geom of type `mesh` without a mesh"
                                            : "a primitive fitted to a mesh is not read");
    const ShapeWord& word = *std::ranges::find(kShapes, geom.shape, &ShapeWord::shape);
    if (said < word.sizes)
      return values.fail(fmt::format("`{}` has {} size{}, expected {}", word.word, said,
                                     said == 1 ? "" : "s", word.sizes));
    const bool endless = geom.shape == Shape::kPlane;
    for (std::size_t i = 0; i < word.sizes && !endless; ++i) {
      if (!(geom.size[static_cast<Eigen::Index>(i)] > 0))
        return values.fail(fmt::format("a size of `{}` is 0", word.word));
    }
    PROBE_TRY(read_rgba(values, geom.rgba));
    if (geom.material != kNone && geom.rgba == kUnsaidRgba)
      geom.rgba = model_.materials[static_cast<std::size_t>(geom.material)].rgba;
    if (values.has("mass")) {
      double mass = 0;
      PROBE_TRY(values.read_not_negative("mass", mass));
      geom.mass = mass;
    }
    PROBE_TRY(values.read_not_negative("density", geom.density));
    PROBE_TRY(values.read("shellinertia", geom.shell));
    PROBE_TRY(values.read("group", geom.group));
    PROBE_TRY(values.read("contype", geom.contype));
    PROBE_TRY(values.read("conaffinity", geom.conaffinity));
    PROBE_TRY(values.read("condim", geom.condim));
    PROBE_TRY(values.read("friction", geom.friction, 1));
    for (const double friction : geom.friction) {
      if (friction < 0) return values.fail("a friction below 0");
    }
    PROBE_TRY(values.read("solref", geom.solref, 1));
    PROBE_TRY(values.read("solimp", geom.solimp, 1));
    PROBE_TRY(values.read("margin", geom.margin));
    model_.bodies[body].geoms.push_back(std::move(geom));
    return {};
  }

  Status read_site(const Element& element, std::size_t body, std::string_view childclass,
                   const Pose& frame) {
    PROBE_TRY(count(sites_, kMostSites, "sites", element));
    PROBE_ASSIGN(const Values values, values_of(element, childclass));
    Site site;
    site.at = element.at;
    PROBE_TRY(values.read("name", site.name));
    std::size_t said = 0;
    PROBE_TRY(read_shape(values, frame, site, said));
    if (site.shape == Shape::kMesh || site.shape == Shape::kPlane)
      return values.fail("a site is a ball, a capsule, an ellipsoid, a cylinder or a box");
    PROBE_TRY(read_rgba(values, site.rgba));
    PROBE_TRY(values.read("group", site.group));
    if (!site.name.empty() && !site_names_.insert(site.name).second)
      note(element.at, "a second site `" + printable(site.name, 60) + "`");
    model_.bodies[body].sites.push_back(std::move(site));
    return {};
  }

  Status read_joint(const Element& element, std::size_t body, std::string_view childclass,
                    const Pose& frame) {
    PROBE_TRY(count(joints_, kMostJoints, "joints", element));
    if (body == 0) return fail(element.at, "a joint of the world");
    PROBE_ASSIGN(const Values values, values_of(element, childclass));
    Joint joint;
    joint.at = element.at;
    PROBE_TRY(values.read("name", joint.name));
    if (!joint.name.empty() && !joint_names_.insert(joint.name).second)
      return fail(element.at, "a second joint `" + printable(joint.name, 60) + "`");
    constexpr std::string_view kMotions[] = {"hinge", "slide", "ball", "free"};
    auto motion =
        static_cast<std::size_t>(element.tag == "freejoint" ? Motion::kFree : Motion::kHinge);
    PROBE_TRY(values.read_word("type", kMotions, motion));
    joint.motion = static_cast<Motion>(motion);
    if (joint.motion == Motion::kFree) {
      model_.bodies[body].joints.push_back(std::move(joint));
      return {};
    }
    PROBE_TRY(values.read("pos", joint.position));
    PROBE_TRY(values.read("axis", joint.axis));
    if (!(joint.axis.norm() > 1e-15)) return values.fail("an axis of no length");
    joint.position = frame.apply(joint.position);
    joint.axis = frame.rotation * joint.axis.normalized();
    const bool turns = joint.motion != Motion::kSlide;
    const double unit = turns && model_.compiler.degrees ? std::numbers::pi / 180 : 1;
    double range[2] = {0, 0};
    PROBE_TRY(values.read("range", range, 2));
    joint.lower = range[0] * unit;
    joint.upper = range[1] * unit;
    constexpr std::string_view kLimited[] = {"false", "true", "auto"};
    std::size_t limited = 2;
    PROBE_TRY(values.read_word("limited", kLimited, limited));
    joint.limited =
        limited == 1 || (limited == 2 && model_.compiler.autolimits && values.has("range"));
    if (limited == 2 && !model_.compiler.autolimits && values.has("range"))
      note(element.at, "a range without `limited`, and no `autolimits`: it is not read");
    if (joint.limited && joint.motion != Motion::kBall && !(joint.lower < joint.upper))
      return values.fail("a range whose second number is not above the first");
    PROBE_TRY(values.read("ref", joint.reference));
    PROBE_TRY(values.read("springref", joint.rest));
    joint.reference *= unit;
    joint.rest *= unit;
    PROBE_TRY(values.read_not_negative("damping", joint.damping));
    PROBE_TRY(values.read_not_negative("frictionloss", joint.friction));
    PROBE_TRY(values.read_not_negative("armature", joint.armature));
    PROBE_TRY(values.read_not_negative("stiffness", joint.stiffness));
    model_.bodies[body].joints.push_back(std::move(joint));
    return {};
  }

  Status read_inertial(const Element& element, std::size_t body) {
    PROBE_TRY(check_leaf(element));
    const Values values(document_, element);
    Body& of = model_.bodies[body];
    if (of.inertial) return fail(element.at, "a second `inertial`");
    if (!values.has("pos") || !values.has("mass"))
      return fail(element.at, "an `inertial` without `pos` or `mass`");
    Inertial inertial;
    PROBE_ASSIGN(inertial.pose, read_pose(values));
    PROBE_TRY(values.read_not_negative("mass", inertial.mass));
    double full[6] = {};
    Vec3 diagonal = Vec3::Zero();
    PROBE_TRY(values.read("fullinertia", full, 6));
    PROBE_TRY(values.read("diaginertia", diagonal));
    if (values.has("fullinertia") == values.has("diaginertia"))
      return fail(element.at, "an `inertial` has either `diaginertia` or `fullinertia`");
    inertial.inertia = diagonal.asDiagonal();
    if (values.has("fullinertia")) {
      inertial.inertia << full[0], full[3], full[4], full[3], full[1], full[5], full[4], full[5],
          full[2];
    }
    const Vec3 moments =
        Eigen::SelfAdjointEigenSolver<Mat3>(inertial.inertia, Eigen::EigenvaluesOnly).eigenvalues();
    constexpr double kRounding = 1e-6;
    const double largest = moments[2] * (1 + kRounding);
    if (moments[0] < 0 || moments[0] + moments[1] < moments[2] - (largest - moments[2]))
      return fail(element.at, "an inertia that no body can have");
    of.inertial = inertial;
    return {};
  }

  // What follows something else is read as if it stood still.
  void check_mode(const Values& values, const Element& element) {
    const auto mode = values.find("mode");
    if (mode && mode->text != "fixed")
      note(element.at, fmt::format("`mode` of `{}` is read as `fixed`", element.tag));
  }

  Status read_camera(const Element& element, std::size_t body, std::string_view childclass,
                     const Pose& frame) {
    PROBE_TRY(count(cameras_, kMostCameras, "cameras", element));
    PROBE_ASSIGN(const Values values, values_of(element, childclass));
    check_mode(values, element);
    Camera camera;
    camera.at = element.at;
    PROBE_TRY(values.read("name", camera.name));
    PROBE_ASSIGN(const Pose pose, read_pose(values));
    camera.pose = frame * pose;
    double fovy = 45;  // degrees whatever the compiler says
    PROBE_TRY(values.read("fovy", fovy));
    if (!(fovy > 0 && fovy < 180)) return values.fail("`fovy` is not between 0 and 180");
    camera.fovy = fovy * (std::numbers::pi / 180);
    model_.bodies[body].cameras.push_back(std::move(camera));
    return {};
  }

  Status read_light(const Element& element, std::size_t body, std::string_view childclass,
                    const Pose& frame) {
    PROBE_TRY(count(lights_, kMostLights, "lights", element));
    PROBE_ASSIGN(const Values values, values_of(element, childclass));
    check_mode(values, element);
    Light light;
    light.at = element.at;
    PROBE_TRY(values.read("name", light.name));
    PROBE_TRY(values.read("pos", light.position));
    PROBE_TRY(values.read("dir", light.direction));
    if (!(light.direction.norm() > 1e-15)) return values.fail("a direction of no length");
    light.position = frame.apply(light.position);
    light.direction = frame.rotation * light.direction.normalized();
    PROBE_TRY(values.read("directional", light.directional));
    PROBE_TRY(values.read("castshadow", light.casts_shadow));
    PROBE_TRY(values.read("ambient", light.ambient, 3));
    PROBE_TRY(values.read("diffuse", light.diffuse, 3));
    PROBE_TRY(values.read("specular", light.specular, 3));
    PROBE_TRY(values.read("attenuation", light.attenuation, 3));
    double cutoff = 45;
    PROBE_TRY(values.read_not_negative("cutoff", cutoff));
    light.cutoff = cutoff * (std::numbers::pi / 180);
    PROBE_TRY(values.read_not_negative("exponent", light.exponent));
    model_.bodies[body].lights.push_back(std::move(light));
    return {};
  }

  const Document& document_;
  const Classes& classes_;
  bool merged_;
  fs::path folder_;
  Model model_;
  std::vector<std::string> textures_of_;  // by material
  std::size_t bodies_ = 0, geoms_ = 0, sites_ = 0, joints_ = 0, lights_ = 0, cameras_ = 0,
              meshes_ = 0, textures_ = 0, materials_ = 0;
  std::set<std::string, std::less<>> body_names_, joint_names_, geom_names_, site_names_;
};

// The settings of the file that a model is merged into.
Result<Compiler> read_settings(const std::string& path) {
  PROBE_ASSIGN(const Document document, read_document(path));
  PROBE_ASSIGN(const Classes classes, Classes::read(document));
  ModelReader reader(document, classes, false);
  for (const Element& section : document.root.children) {
    if (section.tag == "compiler") PROBE_TRY(reader.read_compiler(section));
  }
  return reader.compiler();
}

}  // namespace

std::string Model::where(const At& at) const {
  return fmt::format("{}:{}", files[at.file], at.line);
}

Result<Model> read_model(const std::string& path, const ReadOptions& options) {
  PROBE_ASSIGN(const Document document, read_document(path));
  PROBE_ASSIGN(const Classes classes, Classes::read(document));
  if (options.merged_into.empty()) return ModelReader(document, classes, false).read(nullptr);
  PROBE_ASSIGN(const Compiler settings, read_settings(options.merged_into));
  return ModelReader(document, classes, true).read(&settings);
}

}  // namespace probe::mjcf
