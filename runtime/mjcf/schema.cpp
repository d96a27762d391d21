#include "runtime/mjcf/schema.h"

#include <algorithm>
#include <array>

namespace probe::mjcf {
namespace {

// The attributes of MuJoCo 3.2's XML reference.
constexpr auto kSchemas = std::to_array<ElementSchema>({
    {"compiler",
     "angle autolimits eulerseq meshdir texturedir assetdir strippath inertiafromgeom "
     "inertiagrouprange exactmeshinertia boundmass boundinertia coordinate",
     "settotalmass balanceinertia fitaabb",
     "fusestatic discardvisual usethread convexhull alignfree "
     "saveinertial"},
    {"default", "class", "", ""},
    {"asset", "", "", ""},
    {"worldbody", "", "", ""},
    {"body", "name childclass pos quat axisangle euler xyaxes zaxis", "mocap gravcomp",
     "user sleep"},
    {"frame", "name childclass pos quat axisangle euler xyaxes zaxis", "", ""},
    {"inertial", "pos quat axisangle euler xyaxes zaxis mass diaginertia fullinertia", "", ""},
    {"joint",
     "name class type pos axis range limited ref damping frictionloss armature stiffness springref",
     "springdamper",
     "group margin solreflimit solimplimit solreffriction solimpfriction actuatorfrcrange "
     "actuatorfrclimited actuatorgravcomp user"},
    {"freejoint", "name", "", "group align"},
    {"geom",
     "name class type pos quat axisangle euler xyaxes zaxis fromto size mesh material rgba mass "
     "density shellinertia group contype conaffinity condim friction solref solimp margin",
     "hfield fitscale fluidshape fluidcoef", "priority solmix gap user", "plugin"},
    {"site", "name class type pos quat axisangle euler xyaxes zaxis fromto size rgba group",
     "material", "user"},
    {"camera", "name class pos quat axisangle euler xyaxes zaxis fovy mode",
     "target orthographic resolution focal focalpixel principal principalpixel sensorsize",
     "ipd user"},
    {"light",
     "name class pos dir directional castshadow ambient diffuse specular attenuation cutoff "
     "exponent mode",
     "target type", "active bulbradius"},
    {"mesh", "name class file scale refpos refquat inertia",
     "vertex normal texcoord face builtin params smoothnormal", "content_type maxhullvert",
     "plugin"},
    {"texture",
     "name class type file fileright fileleft fileup filedown filefront fileback builtin rgb1 rgb2 "
     "width height hflip vflip",
     "mark markrgb random gridsize gridlayout nchannel", "content_type colorspace"},
    {"material",
     "name class texture texrepeat texuniform emission specular shininess reflectance rgba",
     "metallic roughness", "", "layer"},
});

constexpr std::string_view kUnreadSections =
    "option size visual statistic custom extension keyframe sensor contact equality tendon "
    "actuator "
    "deformable";
constexpr std::string_view kUnreadAssets = "hfield skin model";
constexpr std::string_view kUnreadInBody = "composite flexcomp attach replicate plugin";

constexpr std::string_view kUnreadInDefault =
    "pair equality tendon general motor position velocity intvelocity damper cylinder muscle "
    "adhesion";

}  // namespace

bool has_word(std::string_view words, std::string_view word) {
  for (std::size_t at = words.find(word); at != words.npos; at = words.find(word, at + 1)) {
    const bool begins = at == 0 || words[at - 1] == ' ';
    const std::size_t end = at + word.size();
    if (begins && (end == words.size() || words[end] == ' ') && !word.empty()) return true;
  }
  return false;
}

const ElementSchema* find_schema(std::string_view tag) {
  const auto found = std::ranges::find(kSchemas, tag, &ElementSchema::tag);
  return found == kSchemas.end() ? nullptr : &*found;
}

bool is_unread_section(std::string_view tag) { return has_word(kUnreadSections, tag); }
bool is_unread_asset(std::string_view tag) { return has_word(kUnreadAssets, tag); }
bool is_unread_in_default(std::string_view tag) { return has_word(kUnreadInDefault, tag); }
bool is_unread_in_body(std::string_view tag) { return has_word(kUnreadInBody, tag); }

}  // namespace probe::mjcf
