#include "runtime/assets/mujoco_text.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "runtime/assets/identifier.h"
#include "runtime/base/trig.h"

namespace probe::assets {
namespace {

std::string number(double value) { return fmt::format("{:.17g}", value + 0.0); }

std::string numbers(const Vec3& v) {
  return number(v.x()) + " " + number(v.y()) + " " + number(v.z());
}

// Turns about the fixed axes x, y and z, in this order, rad: URDF's `rpy`, and the turn of a text.
Vec3 rpy(const Quat& rotation) {
  const Mat3 m = rotation.toRotationMatrix();
  const double level = std::hypot(m(2, 1), m(2, 2));
  const double pitch = portable_atan2(-m(2, 0), level);
  constexpr double kUpright = 1e-9;  // roll and yaw turn about one axis
  if (level < kUpright) return {portable_atan2(-m(1, 2), m(1, 1)), pitch, 0};
  return {portable_atan2(m(2, 1), m(2, 2)), pitch, portable_atan2(m(1, 0), m(0, 0))};
}

std::string origin(const Pose& pose) {
  return fmt::format("<origin xyz=\"{}\" rpy=\"{}\"/>", numbers(pose.position),
                     numbers(rpy(pose.rotation)));
}

// Of a text: as few digits as hold a micrometre of a metre, or a thousandth of a degree.
std::string decimals(double value, int digits) {
  std::string text = fmt::format("{:.{}f}", value, digits);
  if (text.find('.') != text.npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

std::string cm(double metres) { return decimals(100 * metres, 6) + "cm"; }

std::string point(const Vec3& p) {
  return "(" + cm(p.x()) + ", " + cm(p.y()) + ", " + cm(p.z()) + ")";
}

// Nine digits: a millionth of a milligram of a bowl. Products that rounding left are none.
std::string mass_text(const mjcf::MassProperties& m) {
  const double least = 1e-9 * m.inertia.diagonal().maxCoeff();
  const auto centre = [](double metres) {
    return fmt::format("{:.9g}cm", std::abs(metres) < 1e-12 ? 0.0 : 100 * metres);
  };
  const auto moment = [&](Eigen::Index i, Eigen::Index k) {
    const double value = m.inertia(i, k);
    return fmt::format("{:.9g}kgm2", std::abs(value) < least ? 0.0 : value);
  };
  std::string inertia = moment(0, 0) + ", " + moment(1, 1) + ", " + moment(2, 2);
  const std::string products = moment(0, 1) + ", " + moment(0, 2) + ", " + moment(1, 2);
  if (products != "0kgm2, 0kgm2, 0kgm2") inertia += ", " + products;
  return fmt::format("mass {:.9g}kg com ({}, {}, {}) inertia ({})", m.mass, centre(m.center.x()),
                     centre(m.center.y()), centre(m.center.z()), inertia);
}

std::string corners(const Vec3& low, const Vec3& high) { return point(low) + " .. " + point(high); }

std::string degrees(double radians) {
  // Files have quarter turns to five digits.
  const double exact = radians * (180 / std::numbers::pi);
  const double quarter = std::round(exact / 90) * 90;
  return decimals(std::abs(exact - quarter) < 1e-3 ? quarter : exact, 6);
}

std::string turn(const Quat& rotation) {
  const Vec3 angles = rpy(rotation);
  constexpr const char* kWords[] = {"roll", "pitch", "yaw"};
  std::string text;
  for (int i = 0; i < 3; ++i) {
    const std::string value = degrees(angles[i]);
    if (value != "0" && value != "-0") text += fmt::format(" {} {}deg", kWords[i], value);
  }
  return text;
}

std::string words(std::string name) {
  for (char& c : name) {
    if (c == '_') c = ' ';
  }
  return name;
}

// ` region R of P box ..`, where the site is one.
std::string region(const MujocoSite& site, const std::string& of) {
  if (site.region.empty()) return "";
  const std::string turned = turn(site.pose.rotation);
  const std::string head = "  region " + site.region + (of.empty() ? "" : " of " + of) + " box ";
  if (turned.empty())
    return head + corners(site.pose.position - site.half, site.pose.position + site.half) + "\n";
  return head + corners(-site.half, site.half) + " at " + point(site.pose.position) + turned + "\n";
}

}  // namespace

std::string mujoco_identifier(const std::string& name) { return identifier_of(name, "the"); }

std::string fixture_urdf(const std::string& name, const std::vector<DescribedLink>& links,
                         const std::vector<MujocoJoint>& joints) {
  std::string out =
      fmt::format("<?xml version=\"1.0\"?>\n<!-- Made by {}. -->\n<robot name=\"{}\">\n",
                  kMujocoGenerator, name);
  for (const DescribedLink& link : links) {
    out += fmt::format("  <link name=\"{}\">\n", link.name);
    const mjcf::MassProperties& m = link.link->mass;
    if (m.mass > 0) {
      out += fmt::format(
          "    <inertial><origin xyz=\"{}\"/><mass value=\"{}\"/><inertia ixx=\"{}\" iyy=\"{}\" "
          "izz=\"{}\" "
          "ixy=\"{}\" ixz=\"{}\" iyz=\"{}\"/></inertial>\n",
          numbers(m.center), number(m.mass), number(m.inertia(0, 0)), number(m.inertia(1, 1)),
          number(m.inertia(2, 2)), number(m.inertia(0, 1)), number(m.inertia(0, 2)),
          number(m.inertia(1, 2)));
    }
    if (!link.glb.empty())
      out += fmt::format("    <visual><geometry><mesh filename=\"{}\"/></geometry></visual>\n",
                         link.glb);
    for (std::size_t i = 0; i < link.felt.size(); ++i) {
      if (const auto& box = link.felt[i].box) {
        out += fmt::format("    <collision>{}<geometry><box size=\"{}\"/></geometry></collision>\n",
                           origin(box->pose), numbers(2 * box->half));
      } else {
        out +=
            fmt::format("    <collision><geometry><mesh filename=\"{}\"/></geometry></collision>\n",
                        link.meshes[i]);
      }
    }
    out += "  </link>\n";
  }
  for (std::size_t i = 1; i < links.size(); ++i) {
    const DescribedLink& link = links[i];
    const std::string& parent = links[static_cast<std::size_t>(link.link->parent)].name;
    if (link.link->joint == nullptr) {
      out += fmt::format(
          "  <joint name=\"{}_joint\" type=\"fixed\">\n    <parent link=\"{}\"/><child "
          "link=\"{}\"/>"
          "\n  </joint>\n",
          link.name, parent, link.name);
      continue;
    }
    const mjcf::Joint& joint = *link.link->joint;
    const MujocoJoint& made = joints[i - 1];
    const char* type = made.slides ? "prismatic" : joint.limited ? "revolute" : "continuous";
    out += fmt::format(
        "  <joint name=\"{}\" type=\"{}\">\n    <parent link=\"{}\"/><child link=\"{}\"/>{}<axis "
        "xyz=\"{}\"/>\n",
        made.name, type, parent, link.name, origin(link.link->at), numbers(joint.axis));
    // Nobody drives it: effort and velocity are asked for by the format and not read.
    if (joint.limited)
      out += fmt::format("    <limit lower=\"{}\" upper=\"{}\" effort=\"100\" velocity=\"10\"/>\n",
                         number(joint.lower), number(joint.upper));
    out += "  </joint>\n";
  }
  return out + "</robot>\n";
}

std::string object_text(const ObjectText& object, const std::vector<MujocoSite>& sites) {
  std::string out = fmt::format("object {} {{\n  mesh \"{}\"\n  box {}\n", object.name,
                                object.folder, corners(object.low, object.high));
  const std::string weight =
      object.mass ? mass_text(*object.mass) : "density " + decimals(object.density, 6) + "kg/m3";
  out += fmt::format("  {}; friction {}; name \"{}\"\n", weight, decimals(object.friction, 6),
                     object.called);
  if (object.damping != 0)
    out += fmt::format("  damping {0:.9g}Ns/m {0:.9g}Nms/rad\n", object.damping);
  for (const MujocoSite& site : sites) out += region(site, "");
  return out + "}\n";
}

std::string fixture_text(const FixtureText& fixture, const std::vector<DescribedLink>& links,
                         const std::vector<MujocoJoint>& joints,
                         const std::vector<MujocoSite>& sites) {
  std::string out = fmt::format("fixture {} {{\n  urdf \"{}\"; at (0cm, 0cm, 0cm)\n  friction {}\n",
                                fixture.name, fixture.urdf, decimals(fixture.friction, 6));
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const mjcf::Joint& acts = *fixture.acting[i];
    const bool slides = joints[i].slides;
    std::string line;
    if (acts.friction > 0)
      line += fmt::format(" friction {}{}", decimals(acts.friction, 6), slides ? "N" : "Nm");
    if (acts.damping > 0)
      line += fmt::format(" damping {}{}", decimals(acts.damping, 6), slides ? "Ns/m" : "Nms/rad");
    if (acts.stiffness > 0)
      line += fmt::format(" stiffness {}{} at {}", decimals(acts.stiffness, 6),
                          slides ? "N/m" : "Nm/rad",
                          slides ? cm(acts.rest) : degrees(acts.rest) + "deg");
    if (acts.armature > 0)
      line += fmt::format(" armature {}{}", decimals(acts.armature, 9), slides ? "kg" : "kgm2");
    if (!line.empty()) out += "  joint " + joints[i].name + line + "\n";
  }
  for (std::size_t i = 1; i < links.size(); ++i) {
    if (!links[i].felt.empty())
      out += fmt::format("  part {} link {} name \"{}\"\n", links[i].name, links[i].name,
                         words(links[i].link->name.empty() ? links[i].name : links[i].link->name));
  }
  for (const MujocoSite& site : sites)
    out += region(site, site.part.empty() ? fixture.name : site.part);
  for (const GlowText& glow : fixture.glows)
    out += fmt::format("  shown {} while {} >= {}\n", glow.link, glow.joint,
                       glow.slides ? cm(glow.from) : decimals(glow.from, 9) + "rad");
  return out + "}\n";
}

}  // namespace probe::assets
