// The scan: elements in file order, then the shape of the tree.
#include "runtime/robot/urdf_text.h"

#include <tinyxml.h>
#include <urdf_model/utils.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "runtime/base/xml_size.h"
#include "runtime/robot/rotation.h"

namespace probe::robot {
namespace {

// A humanoid with hands has a hundred links; reading takes the square of the links.
constexpr std::size_t kMostLinks = 1024;

class Scanner {
 public:
  Scanner(const std::string& text, const std::string& path) : text_(text), path_(path) {}

  Result<UrdfText> scan() {
    PROBE_TRY(check_size());
    TiXmlDocument document;
    document.Parse(text_.c_str(), nullptr, TIXML_ENCODING_UTF8);
    if (document.Error()) {
      return Failure{Fault::kUrdf, fmt::format("not XML: {}", document.ErrorDesc()),
                     at(document.ErrorRow())};
    }
    const TiXmlElement* robot = document.RootElement();
    if (robot == nullptr) return Failure{Fault::kUrdf, "not XML: no element in it", path_};
    if (robot->ValueStr() != "robot") {
      return Failure{Fault::kUrdf,
                     fmt::format("the outermost element is `{}`, not `robot`", robot->ValueStr()),
                     at(robot->Row())};
    }
    for (const TiXmlElement* e = robot->FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (e->ValueStr() == "link") PROBE_TRY(add_link(*e));
      if (e->ValueStr() == "joint") PROBE_TRY(add_joint(*e));
      if (result_.links.size() > kMostLinks || result_.joints.size() > kMostLinks) {
        return Failure{Fault::kUrdf, fmt::format("more than {} links or joints", kMostLinks),
                       path_};
      }
    }
    PROBE_TRY(check_tree());
    return std::move(result_);
  }

 private:
  std::string at(int line) const { return fmt::format("{}:{}", path_, line); }

  Status check_size() const {
    std::size_t elements = 0;
    return check_xml_size(text_, Fault::kUrdf, path_, &elements);
  }

  Result<std::string> named(const TiXmlElement& e, const char* attribute) const {
    const char* value = e.Attribute(attribute);
    if (value == nullptr || *value == '\0') {
      return Failure{Fault::kUrdf, fmt::format("a `{}` without its `{}`", e.ValueStr(), attribute),
                     at(e.Row())};
    }
    return std::string(value);
  }

  // The rotation of e's <origin rpy="..">, identity where none is written.
  Result<Quat> rotation_of(const TiXmlElement& e) const {
    const TiXmlElement* origin = e.FirstChildElement("origin");
    const char* rpy = origin ? origin->Attribute("rpy") : nullptr;
    if (rpy == nullptr) return Quat::Identity();
    std::vector<std::string> words;
    urdf::split_string(words, rpy, " \t\n\r");
    std::erase(words, std::string());
    Vec3 angles;
    if (words.size() != 3) return not_angles(*origin, rpy);
    try {
      for (int i = 0; i < 3; ++i) angles[i] = urdf::strToDouble(words[std::size_t(i)].c_str());
    } catch (const std::exception&) {
      return not_angles(*origin, rpy);
    }
    // Beyond this the reduction of the angle loses digits, and nobody means it.
    if (!(angles.cwiseAbs().maxCoeff() < 1e4)) return not_angles(*origin, rpy);
    return from_rpy(angles);
  }

  Failure not_angles(const TiXmlElement& origin, const char* rpy) const {
    return Failure{Fault::kUrdf, fmt::format("`rpy` is `{}`, not three angles", rpy),
                   at(origin.Row())};
  }

  Status add_link(const TiXmlElement& e) {
    LinkText link;
    PROBE_ASSIGN(link.name, named(e, "name"));
    const auto [old, fresh] = links_.try_emplace(link.name, int(result_.links.size()));
    if (!fresh)
      return Failure{Fault::kUrdf, fmt::format("two links are named `{}`", link.name), at(e.Row())};
    if (const TiXmlElement* inertial = e.FirstChildElement("inertial")) {
      PROBE_ASSIGN(link.inertial, rotation_of(*inertial));
    }
    PROBE_TRY(add_origins(e, "visual", link.visuals));
    PROBE_TRY(add_origins(e, "collision", link.collisions));
    result_.links.push_back(std::move(link));
    return {};
  }

  Status add_origins(const TiXmlElement& link, const char* kind, std::vector<Quat>& out) const {
    for (const TiXmlElement* e = link.FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) {
      PROBE_ASSIGN(const Quat rotation, rotation_of(*e));
      out.push_back(rotation);
    }
    return {};
  }

  Status add_joint(const TiXmlElement& e) {
    JointText joint;
    PROBE_ASSIGN(joint.name, named(e, "name"));
    if (!joints_.try_emplace(joint.name, int(result_.joints.size())).second) {
      return Failure{Fault::kUrdf, fmt::format("two joints are named `{}`", joint.name),
                     at(e.Row())};
    }
    PROBE_ASSIGN(const std::string type, named(e, "type"));
    if (type != "fixed" && type != "revolute" && type != "continuous" && type != "prismatic") {
      return Failure{Fault::kUrdf,
                     fmt::format("joint `{}` is of type `{}`, only fixed, revolute, continuous and "
                                 "prismatic ones are moved here",
                                 joint.name, type),
                     at(e.Row())};
    }
    for (const char* end : {"parent", "child"}) {
      const TiXmlElement* link = e.FirstChildElement(end);
      if (link == nullptr) {
        return Failure{Fault::kUrdf, fmt::format("joint `{}` has no `{}`", joint.name, end),
                       at(e.Row())};
      }
      PROBE_ASSIGN((end[0] == 'p' ? joint.parent : joint.child), named(*link, "link"));
    }
    if (type == "revolute" || type == "prismatic") PROBE_TRY(check_limits(e, joint.name));
    PROBE_ASSIGN(joint.origin, rotation_of(e));
    lines_.push_back(e.Row());
    result_.joints.push_back(std::move(joint));
    return {};
  }

  // URDF reads an absent limit as 0, which nobody wants.
  Status check_limits(const TiXmlElement& joint, const std::string& name) const {
    const TiXmlElement* limit = joint.FirstChildElement("limit");
    for (const char* attribute : {"lower", "upper"}) {
      if (limit != nullptr && limit->Attribute(attribute) != nullptr) continue;
      return Failure{Fault::kUrdf, fmt::format("joint `{}` has no `{}` limit", name, attribute),
                     at((limit ? limit : &joint)->Row())};
    }
    return {};
  }

  Status check_tree() {
    if (result_.links.empty()) return Failure{Fault::kUrdf, "a robot without links", path_};
    std::vector<int> parent(result_.links.size(), -1);  // link -> the joint above
    for (std::size_t j = 0; j < result_.joints.size(); ++j) {
      const JointText& joint = result_.joints[j];
      for (const std::string& link : {joint.parent, joint.child}) {
        if (links_.count(link)) continue;
        return Failure{
            Fault::kUrdf,
            fmt::format("joint `{}` names the link `{}`, which is not there", joint.name, link),
            at(lines_[j])};
      }
      int& above = parent[std::size_t(links_[joint.child])];
      if (above >= 0) {
        return Failure{Fault::kUrdf,
                       fmt::format("link `{}` hangs on two joints, `{}` and `{}`", joint.child,
                                   result_.joints[std::size_t(above)].name, joint.name),
                       at(lines_[j])};
      }
      above = int(j);
    }
    PROBE_TRY(check_loops(parent));
    const auto root = std::find(parent.begin(), parent.end(), -1);
    const auto second = std::find(root + 1, parent.end(), -1);
    result_.root = int(root - parent.begin());
    if (second == parent.end()) return {};
    return Failure{Fault::kUrdf,
                   fmt::format("several roots: no joint leads to `{}` nor to `{}`",
                               result_.links[std::size_t(result_.root)].name,
                               result_.links[std::size_t(second - parent.begin())].name),
                   path_};
  }

  // Each link has one joint above at most, so a walk upwards either ends at a root or goes round.
  Status check_loops(const std::vector<int>& parent) const {
    for (std::size_t start = 0; start < parent.size(); ++start) {
      std::size_t link = start;
      for (std::size_t steps = 0; parent[link] >= 0; ++steps) {
        const JointText& joint = result_.joints[std::size_t(parent[link])];
        if (steps > parent.size()) {
          return Failure{Fault::kUrdf,
                         fmt::format("a loop: joint `{}` leads from `{}` back to `{}`", joint.name,
                                     joint.parent, joint.child),
                         at(lines_[std::size_t(parent[link])])};
        }
        link = std::size_t(links_.at(joint.parent));
      }
    }
    return {};
  }

  const std::string& text_;
  const std::string& path_;
  UrdfText result_;
  std::vector<int> lines_;  // of joints
  std::map<std::string, int> links_, joints_;
};

}  // namespace

Result<UrdfText> scan_urdf(const std::string& text, const std::string& path) {
  return Scanner(text, path).scan();
}

}  // namespace probe::robot
