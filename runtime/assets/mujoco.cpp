// Reads a model, finds the thing in it and puts together what the other files of this stem make.
#include "runtime/assets/mujoco.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <filesystem>
#include <map>
#include <set>

#include "runtime/assets/mujoco_felt.h"
#include "runtime/assets/mujoco_seen.h"
#include "runtime/assets/mujoco_text.h"
#include "runtime/assets/mujoco_thing.h"
#include "runtime/mjcf/read.h"
#include "runtime/scene/collision_mesh.h"
#include "runtime/scene/hull.h"

namespace probe::assets {
namespace {

namespace fs = std::filesystem;
using mjcf::Model;

class Conversion {
 public:
  Conversion(const MujocoOptions& options, const Model& model, scene::MeshLimits limits)
      : options_(options), model_(model), meshes_(model, std::move(limits)) {
    const std::string stem = fs::path(options.file).stem().string();
    asset_.name = options.name.empty() ? mujoco_identifier(stem) : options.name;
    folder_ = options.folder.empty() ? asset_.name : options.folder;
    called_ = options.called;
    if (called_.empty()) {
      called_ = asset_.name;
      std::ranges::replace(called_, '_', ' ');
    }
    for (const mjcf::Note& note : model.notes)
      asset_.notes.push_back(model.where(note.at) + ": " + note.text);
  }

  Result<MujocoAsset> run() {
    if (options_.kind == MujocoKind::kBackdrop) {
      PROBE_TRY(make_backdrop());
      return std::move(asset_);
    }
    PROBE_ASSIGN(thing_, find_thing(model_, meshes_));
    for (const mjcf::Geom* geom : thing_.of_world)
      note(geom->at, "a geom of the world is no part of the thing");
    const bool moves = thing_.links.size() > 1;
    asset_.kind = options_.kind;
    if (asset_.kind == MujocoKind::kEither) {
      asset_.kind = moves ? MujocoKind::kFixture : MujocoKind::kObject;
      if (!moves && !thing_.is_free && !thing_.is_wrapped)
        asset_.notes.push_back(options_.file +
                               ": nothing in it moves: taken as an object; say if it is a fixture");
    }
    if (asset_.kind == MujocoKind::kObject && moves)
      return Failure{Fault::kAsset,
                     "an object whose parts move on joints: it can only be a fixture",
                     model_.where(thing_.links[1].joint->at)};
    if (asset_.kind == MujocoKind::kFixture && thing_.is_free)
      asset_.notes.push_back(options_.file +
                             ": its free joint is left out: a fixture stands where it is put");
    for (const MujocoLink& link : thing_.links) {
      PROBE_ASSIGN(
          std::vector<FeltPart> parts,
          felt_parts(model_, link, meshes_, asset_.kind == MujocoKind::kObject, asset_.notes));
      felt_.push_back(std::move(parts));
    }
    PROBE_TRY(measure());
    PROBE_TRY(asset_.kind == MujocoKind::kObject ? make_object() : make_fixture());
    for (const mjcf::Site* site : thing_.outside) {
      MujocoSite made = site_of(*site, site->pose, "");
      made.outside = true;
      asset_.sites.push_back(std::move(made));
    }
    return std::move(asset_);
  }

 private:
  void note(const mjcf::At& at, const std::string& text) {
    asset_.notes.push_back(model_.where(at) + ": " + text);
  }

  // ---- what is said of the whole

  Status measure() {
    bool first = true;
    std::map<double, std::size_t> frictions;
    for (std::size_t i = 0; i < thing_.links.size(); ++i) {
      const Pose pose = frame_of(i);
      for (const FeltPart& part : felt_[i]) {
        for (const Vec3& corner : part.corners) {
          const Vec3 p = pose.apply(corner);
          asset_.low = first ? p : Vec3(asset_.low.cwiseMin(p));
          asset_.high = first ? p : Vec3(asset_.high.cwiseMax(p));
          first = false;
        }
      }
      mass_ = mjcf::joined(mass_, mjcf::moved(thing_.links[i].mass, pose));
      for (const auto& placed : thing_.links[i].geoms) {
        if (placed.it->can_touch()) ++frictions[placed.it->friction[0]];
      }
    }
    if (first) return Failure{Fault::kAsset, "nothing of it can be touched", options_.file};
    asset_.mass = mass_.mass;
    asset_.center_of_mass = mass_.center;
    asset_.friction =
        std::ranges::max_element(frictions, {}, [](const auto& f) { return f.second; })->first;
    if (frictions.size() > 1) {
      std::string list;
      for (const auto& [friction, count] : frictions)
        list += fmt::format("{}{:g} of {}", list.empty() ? "" : ", ", friction, count);
      asset_.notes.push_back(fmt::format("{}: friction differs by geom ({}), {:g} is taken for all",
                                         options_.file, list, asset_.friction));
    }
    return {};
  }

  // A link's frame in the thing's, joints at 0.
  Pose frame_of(std::size_t link) const {
    Pose pose;
    for (int i = static_cast<int>(link); i >= 0;
         i = thing_.links[static_cast<std::size_t>(i)].parent)
      pose = thing_.links[static_cast<std::size_t>(i)].at * pose;
    return pose;
  }

  MujocoSite site_of(const mjcf::Site& site, const Pose& pose, const std::string& part) const {
    MujocoSite made;
    made.name = site.name;
    made.part = part;
    made.pose = pose;
    made.half = site.shape == mjcf::Shape::kBox || site.shape == mjcf::Shape::kEllipsoid ? site.size
                : site.shape == mjcf::Shape::kSphere
                    ? Vec3(Vec3::Constant(site.size[0]))
                    : Vec3(site.size[0], site.size[0], site.size[1]);
    return made;
  }

  // Sites of a link; boxes become regions, by names that are still free.
  void add_sites(const MujocoLink& link, const std::string& part, std::set<std::string>& taken) {
    for (const Placed<mjcf::Site>& placed : link.sites) {
      MujocoSite site = site_of(*placed.it, placed.pose, part);
      if (placed.it->shape == mjcf::Shape::kBox && !site.name.empty()) {
        std::string name = mujoco_identifier(site.name);
        if (taken.contains(name)) name += "_region";
        if (taken.insert(name).second) {
          site.region = name;
        } else {
          note(placed.it->at, "a second region of this name is left out");
        }
      }
      asset_.sites.push_back(std::move(site));
    }
  }

  void add_file(const std::string& path, std::string bytes) {
    asset_.files.push_back({path, std::move(bytes), options_.file});
  }

  // ---- kinds

  Status make_object() {
    const MujocoLink& link = thing_.links[0];
    const std::string below = "objects/" + folder_;
    PROBE_ASSIGN(std::string seen, seen_link(model_, link, seen_groups(thing_.links), asset_.name,
                                             meshes_, pictures_, asset_.notes));
    if (seen.empty()) return Failure{Fault::kAsset, "nothing of it can be seen", options_.file};
    add_file(below + "/visual.glb", std::move(seen));
    const std::string obj = felt_obj(felt_[0]);
    std::vector<std::vector<Vec3>> components;
    for (const FeltPart& part : felt_[0]) components.push_back(part.corners);
    if (components.size() > scene::kMaxCollisionParts)
      return Failure{Fault::kAsset,
                     fmt::format("{} parts are felt, at most {}", components.size(),
                                 scene::kMaxCollisionParts),
                     options_.file};
    PROBE_ASSIGN(
        const scene::CollisionShape shape,
        scene::make_collision_shape(components, options_.file, {.max_vertices = kMostCorners}));
    if (shape.parts.size() != components.size())
      asset_.notes.push_back(fmt::format("{}: {} of {} parts are too thin to be felt",
                                         options_.file, components.size() - shape.parts.size(),
                                         components.size()));
    add_file(below + "/collision.obj", obj);
    ObjectText text;
    text.name = asset_.name;
    text.folder = folder_;
    text.called = called_;
    text.low = asset_.low;
    text.high = asset_.high;
    text.friction = asset_.friction;
    text.damping = thing_.is_free ? thing_.free_damping : options_.free_damping;
    if (!(mass_.mass > 0)) return Failure{Fault::kAsset, "it weighs nothing", options_.file};
    text.density = mass_.mass / shape.volume;
    // What is as heavy everywhere is said by its density, all else as the file has it.
    const double off = (shape.center_of_mass - mass_.center).norm();
    const double turn =
        (text.density * shape.unit_inertia - mass_.inertia).norm() / mass_.inertia.norm();
    if (off > 1e-7 || turn > 1e-6) text.mass = mass_;
    std::set<std::string> taken;
    add_sites(link, "", taken);
    asset_.declaration = object_text(text, asset_.sites);
    return {};
  }

  Status make_fixture() {
    const std::string below = "fixtures/" + folder_;
    std::set<std::string> taken;
    std::vector<const mjcf::Joint*> acting;
    for (std::size_t i = 1; i < thing_.links.size(); ++i) {
      const mjcf::Joint& joint = *thing_.links[i].joint;
      MujocoJoint made;
      made.name = free_name(joint.name.empty() ? thing_.links[i].name + "_joint" : joint.name,
                            "_joint", taken);
      made.slides = joint.motion == mjcf::Motion::kSlide;
      made.lower = joint.limited ? joint.lower : 0;
      made.upper = joint.limited ? joint.upper : 0;
      acting.push_back(&joint);
      asset_.joints.push_back(std::move(made));
    }
    // Regions come before parts: sites are what texts ask about.
    std::set<std::string> regions;
    for (const MujocoLink& link : thing_.links) {
      for (const auto& placed : link.sites) {
        if (placed.it->shape == mjcf::Shape::kBox && !placed.it->name.empty())
          regions.insert(mujoco_identifier(placed.it->name));
      }
    }
    std::vector<DescribedLink> links;
    const std::set<int> groups = seen_groups(thing_.links);
    for (std::size_t i = 0; i < thing_.links.size(); ++i) {
      const MujocoLink& link = thing_.links[i];
      DescribedLink described;
      described.link = &link;
      std::set<std::string> others = taken;
      others.insert(regions.begin(), regions.end());
      described.name = i == 0 ? "root"
                              : free_name(link.name.empty() ? asset_.joints[i - 1].name : link.name,
                                          "_part", others);
      if (i > 0) {
        taken.insert(described.name);
        asset_.joints[i - 1].part = described.name;
      }
      PROBE_ASSIGN(std::string seen, seen_link(model_, link, groups, described.name, meshes_,
                                               pictures_, asset_.notes));
      if (!seen.empty()) {
        described.glb = "meshes/" + described.name + ".glb";
        add_file(below + "/" + described.glb, std::move(seen));
      }
      described.felt = felt_[i];
      for (std::size_t k = 0; k < felt_[i].size(); ++k) {
        described.meshes.emplace_back();
        if (felt_[i][k].box) continue;
        described.meshes.back() =
            fmt::format("meshes/{}_{}_{}_collision.obj", described.name, felt_[i][k].kind, k + 1);
        add_file(below + "/" + described.meshes.back(), felt_obj({felt_[i][k]}));
      }
      if (i > 0 && felt_[i].empty())
        asset_.notes.push_back(
            fmt::format("{}: nothing of part `{}` can be touched: it is no part of the text",
                        options_.file, described.name));
      links.push_back(std::move(described));
    }
    for (std::size_t i = 0; i < links.size(); ++i) {
      if (i > 0 && links[i].felt.empty() && !links[i].link->sites.empty()) {
        for (const auto& placed : links[i].link->sites)
          asset_.sites.push_back(site_of(*placed.it, placed.pose, links[i].name));
        continue;
      }
      add_sites(*links[i].link, i == 0 ? "" : links[i].name, taken);
    }
    FixtureText text;
    for (const MujocoGlow& glow : options_.glows) {
      taken.insert(regions.begin(), regions.end());
      PROBE_TRY(add_glow(glow, below, taken, links, text));
    }
    add_file(below + "/" + asset_.name + ".urdf", fixture_urdf(asset_.name, links, asset_.joints));
    text.name = asset_.name;
    text.urdf = below + "/" + asset_.name + ".urdf";
    text.called = called_;
    text.friction = asset_.friction;
    text.acting = std::move(acting);
    asset_.declaration = fixture_text(text, links, asset_.joints, asset_.sites);
    return {};
  }

  // A site as a link of its own, fixed to the one that has it.
  Status add_glow(const MujocoGlow& glow, const std::string& below, std::set<std::string>& taken,
                  std::vector<DescribedLink>& links, FixtureText& text) {
    std::size_t joint = 0;
    while (joint < asset_.joints.size() && thing_.links[joint + 1].joint->name != glow.joint)
      ++joint;
    if (joint == asset_.joints.size())
      return left_out("no joint `" + glow.joint + "`, which is to show a site");
    const auto [parent, site] = find_site(glow.site);
    if (site == nullptr) return left_out("no site `" + glow.site + "`, which is to be shown");
    mjcf::Geom& geom = glows_.emplace_back();
    geom.shape = site->it->shape;
    geom.size = site->it->size;
    geom.rgba = site->it->rgba;
    geom.group = site->it->group;
    geom.contype = geom.conaffinity = 0;
    geom.at = site->it->at;
    MujocoLink& link = glow_links_.emplace_back();
    link.parent = parent;
    link.geoms.push_back({&geom, site->pose});
    DescribedLink described;
    described.link = &link;
    described.name = free_name(glow.site, "_glow", taken);
    described.glb = "meshes/" + described.name + ".glb";
    PROBE_ASSIGN(std::string seen, seen_link(model_, link, {geom.group}, described.name, meshes_,
                                             pictures_, asset_.notes));
    if (seen.empty()) return left_out("site `" + glow.site + "`, which is to be shown, is clear");
    add_file(below + "/" + described.glb, std::move(seen));
    text.glows.push_back(
        {described.name, asset_.joints[joint].name, asset_.joints[joint].slides, glow.from});
    links.push_back(std::move(described));
    return {};
  }

  // The first of that name, with the link that has it; null where none is called so.
  std::pair<int, const Placed<mjcf::Site>*> find_site(const std::string& name) const {
    for (std::size_t i = 0; i < thing_.links.size(); ++i) {
      for (const Placed<mjcf::Site>& placed : thing_.links[i].sites) {
        if (placed.it->name == name) return {static_cast<int>(i), &placed};
      }
    }
    return {-1, nullptr};
  }

  Status left_out(const std::string& why) {
    asset_.notes.push_back(options_.file + ": " + why);
    return {};
  }

  static std::string free_name(const std::string& wanted, const std::string& suffix,
                               std::set<std::string>& taken) {
    std::string name = mujoco_identifier(wanted);
    if (taken.contains(name)) name += suffix;
    const std::string stem = name;
    for (int i = 2; !taken.insert(name).second; ++i) name = fmt::format("{}_{}", stem, i);
    return name;
  }

  Status make_backdrop() {
    asset_.kind = MujocoKind::kBackdrop;
    thing_ = standing_things(model_, asset_.notes);
    const MujocoLink& link = thing_.links[0];
    PROBE_ASSIGN(std::string seen, seen_link(model_, link, seen_groups(thing_.links), asset_.name,
                                             meshes_, pictures_, asset_.notes));
    if (seen.empty()) return Failure{Fault::kAsset, "nothing of it can be seen", options_.file};
    add_file("scenes/" + folder_ + "/visual.glb", std::move(seen));
    for (const auto& placed : link.sites)
      asset_.sites.push_back(site_of(*placed.it, placed.pose, ""));
    for (const auto& placed : link.geoms) add_surface(*placed.it, placed.pose);
    return {};
  }

  void add_surface(const mjcf::Geom& geom, const Pose& pose) {
    if (!geom.can_touch()) return;
    const bool plane = geom.shape == mjcf::Shape::kPlane;
    if (!plane && geom.shape != mjcf::Shape::kBox) {
      note(geom.at, "is felt and is no box and no plane: it is only seen");
      return;
    }
    MujocoSurface made;
    for (const mjcf::Body& body : model_.bodies) {
      for (const mjcf::Geom& other : body.geoms) {
        if (&other == &geom) made.body = body.name;
      }
    }
    made.name = geom.name;
    made.pose = pose;
    made.half = plane ? Vec3(geom.size[0], geom.size[1], 0) : geom.size;
    made.friction = geom.friction[0];
    made.top = pose.position.z();
    const Mat3 turn = pose.rotation.toRotationMatrix();
    if (!plane) made.top += turn.row(2).cwiseAbs().dot(made.half.transpose());
    asset_.surfaces.push_back(std::move(made));
  }

  const MujocoOptions& options_;
  const Model& model_;
  MujocoMeshes meshes_;
  MujocoPictures pictures_;
  MujocoThing thing_;
  std::deque<mjcf::Geom> glows_;  // sites, as what is seen
  std::deque<MujocoLink> glow_links_;
  std::vector<std::vector<FeltPart>> felt_;  // by link
  mjcf::MassProperties mass_;                // of all, in the thing's frame
  MujocoAsset asset_;
  std::string folder_, called_;
};

// Bodies and geoms of the name are changed; a visual geom and a felt one have names of their own.
Status apply(const MujocoChange& change, const std::string& file, Model& model) {
  std::size_t found = 0;
  if (!change.picture.empty()) {
    for (mjcf::Texture& texture : model.textures) {
      if (texture.name != change.name) continue;
      ++found;
      texture.file = (fs::path(file).parent_path() / change.picture).string();
    }
    if (found == 1) return {};
    return Failure{
        Fault::kAsset,
        fmt::format("{} textures are called `{}`, which is to be changed", found, change.name),
        file};
  }
  for (mjcf::Body& body : model.bodies) {
    if (body.name == change.name && !change.size && !change.friction) {
      ++found;
      if (change.position) body.pose.position = *change.position;
    }
    for (mjcf::Geom& geom : body.geoms) {
      if (geom.name != change.name) continue;
      ++found;
      if (change.position) geom.pose.position = *change.position;
      if (change.size) geom.size = *change.size;
      if (change.friction) geom.friction[0] = *change.friction;
    }
  }
  if (found == 1 && !change.name.empty()) return {};
  return Failure{Fault::kAsset,
                 fmt::format("{} {} called `{}`, which is to be changed", found,
                             change.size || change.friction ? "geoms are" : "bodies and geoms are",
                             change.name),
                 file};
}

}  // namespace

Result<MujocoAsset> convert_mujoco(const MujocoOptions& options) {
  PROBE_ASSIGN(Model model, mjcf::read_model(options.file, {options.merged_into}));
  for (const MujocoChange& change : options.changes) PROBE_TRY(apply(change, options.file, model));
  scene::MeshLimits limits;
  // Files of a benchmark's objects lie beside those of its scenes: two folders up.
  const fs::path folder = fs::absolute(options.file).lexically_normal().parent_path();
  limits.asset_root = folder.parent_path().parent_path().string();
  return Conversion(options, model, std::move(limits)).run();
}

}  // namespace probe::assets
