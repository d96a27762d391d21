// A suite small enough to read: a two-jointed arm with two fingers, a red and a blue block, one
// task. Tests put their own lines behind it. Asset files are written to a temporary folder once per
// process.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "compiler/check/analyze.h"
#include "compiler/diag/text.h"
#include "compiler/syntax/parser.h"

namespace probe::test {

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

inline std::string arm_urdf() {
  const std::string inertial =
      "<inertial><mass value=\"1\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" ixy=\"0\" "
      "ixz=\"0\" iyz=\"0\"/></inertial>";
  const std::string mesh =
      "<collision><geometry><mesh filename=\"part.obj\"/></geometry></collision>";
  const auto link = [&](const std::string& name, bool touches) {
    return "<link name=\"" + name + "\">" + inertial + (touches ? mesh : "") + "</link>";
  };
  const auto joint = [](const std::string& name, const std::string& type, const std::string& parent,
                        const std::string& child, const std::string& axis = "0 1 0") {
    return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
           "\"/><child link=\"" + child + "\"/><axis xyz=\"" + axis +
           "\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" "
           "velocity=\"1\"/></joint>";
  };
  return "<robot name=\"arm\">" + link("base", true) + link("wrist", true) + link("left", true) +
         link("right", true) + link("tool", false) + joint("waist", "revolute", "base", "wrist") +
         joint("l", "prismatic", "wrist", "left") +
         joint("r", "prismatic", "wrist", "right", "0 -1 0") +
         joint("t", "fixed", "wrist", "tool") + "</robot>";
}

// A drawer that slides by 20 cm, a door that opens by 90 degrees and is closed at its upper limit,
// a lid that is fixed, and a bell that nothing can touch, on a body.
inline std::string chest_urdf() {
  const auto link = [](const std::string& name, bool touches) {
    return "<link name=\"" + name +
           "\"><inertial><mass value=\"1\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" ixy=\"0\" "
           "ixz=\"0\" iyz=\"0\"/></inertial>" +
           (touches ? "<collision><geometry><box size=\"0.1 0.1 0.1\"/></geometry></collision>"
                    : "") +
           "</link>";
  };
  const auto joint = [](const std::string& name, const std::string& type, const std::string& child,
                        const std::string& limits, const std::string& axis = "1 0 0") {
    return "<joint name=\"" + name + "\" type=\"" + type +
           "\"><parent link=\"body\"/><child link=\"" + child + "\"/><axis xyz=\"" + axis +
           "\"/><limit " + limits + " effort=\"1\" velocity=\"1\"/></joint>";
  };
  return "<robot name=\"chest\">" + link("body", true) + link("drawer", true) + link("door", true) +
         link("lid", true) + link("bell", false) +
         "<link name=\"light\"><visual><geometry><box size=\"0.01 0.01 0.01\"/></geometry>"
         "</visual></link>" +
         joint("slide", "prismatic", "drawer", "lower=\"0\" upper=\"0.2\"") +
         joint("hinge", "revolute", "door", "lower=\"-1.5\" upper=\"0\"", "0 0 1") +
         joint("glue", "fixed", "lid", "lower=\"0\" upper=\"0\"") +
         joint("wire", "fixed", "light", "lower=\"0\" upper=\"0\"") +
         joint("ring", "continuous", "bell", "lower=\"0\" upper=\"0\"") + "</robot>";
}

// Stands in `room`, which `kSmallSuite` does not have.
inline const char* const kChest = R"(
fixture chest {
  urdf "chest/chest.urdf"; at (0cm, 30cm, 85cm) yaw 90deg
  joint slide friction 2N damping 5Ns/m start 4cm
  joint hinge friction 1Nm stiffness 0.5Nm/rad at 0deg stay
  part drawer link drawer name "drawer"
  part door link door
  region inside of drawer box (-4cm, -4cm, -4cm) .. (4cm, 4cm, 4cm)
  region top of chest box (-5cm, -5cm, 5cm) .. (5cm, 5cm, 15cm)
}
scene room like bench { fixture chest }
)";

// The folder of this process' assets.
inline std::string asset_root() {
  static const std::string root = [] {
    const auto folder =
        std::filesystem::temp_directory_path() / ("probe_assets_" + std::to_string(getpid()));
    write_text(folder / "arm/arm.urdf", arm_urdf());
    write_text(folder / "arm/part.obj", "v 0 0 0\n");
    write_text(folder / "chest/chest.urdf", chest_urdf());
    for (const char* object : {"block", "tray"}) {
      write_text(folder / "objects" / object / "visual.glb", std::string("visual of ") + object);
      write_text(folder / "objects" / object / "collision.obj",
                 std::string("collision of ") + object);
    }
    return folder.string();
  }();
  return root;
}

inline const char* const kSmallSuite = R"(
dataset lab "Lab" { relations red on tray }
attribute color { red, blue, gray }
attribute category { toy, dish }
facts { favorite }
object red {
  mesh "block"; box 4cm x 2cm x 2cm; density 500kg/m3; friction 0.5
  color red; category toy; is favorite; seen in lab; rest yaw 0deg, yaw 90deg; name "red block"
  phrase by_color appearance "red thing" means color red
  phrase loved commonsense "everybody's darling" bare means favorite
  phrase toy appearance "toy" means category toy
}
object blue like red { color blue; paint blue; name "blue block" }
object pale {
  mesh "block"; box 2cm x 2cm x 2cm; density 500kg/m3; friction 0.5
  category dish; unseen; rest yaw 0deg, yaw 0deg; name "pale block"
}
object tray {
  mesh "tray"; box 6cm x 6cm x 1cm; density 500kg/m3; friction 0.5
  color gray; category dish; seen in lab; rest yaw 0deg, yaw 0deg; name "tray"
}
robot arm {
  urdf "arm/arm.urdf"; tcp tool; fingers left opens +y, right opens -y; control ee_delta_pose 5Hz
  drive waist stiffness 100Nm/rad damping 10Nms/rad limit 20Nm
  drive l, r stiffness 1000N/m damping 200Ns/m limit 60N
  grip 1cm .. 4cm friction 2 patch 1cm
}
camera eye { mount arm.base at (0cm, 0cm, 1m) look (1, 0, -1); image 64 x 48; lens 30px, 30px, 32px, 24px }
light day { ambient 0.3; sun (0, 0, -1) power 2 }
light night { ambient 0.1 }
scene bench {
  robot arm at (50cm, 0cm) yaw 180deg; joints (0rad, 2cm, 2cm); surface 80cm area (-50cm, -50cm) .. (50cm, 50cm)
  camera eye; light day; physics 500Hz friction 1
}
layout pairs {
  cells spots = grid 2 x 2 at (0cm, 0cm) spread (10cm, 10cm)
  place source, target in distinct spots
  place distractors in remaining spots
  orient by rest
  drop 10cm settle 0.5s
}
template put frame put "put {source} on {the target}"
template take frame take "take {the source} to {the target}"
metrics plain { success = at end (height(source) > height(target)) }
abstract task base { scene bench; layout pairs; metrics plain; say put; horizon 60 steps }
task red_on_tray like base { source red; target tray }
)";

struct Analysis {
  SourceSet sources;
  Diagnostics diagnostics;
  std::vector<syntax::ParseResult> files;
  sema::Model model;

  // The codes of errors and warnings, in the order in which they were found: "P0201 P0302".
  std::string codes() const {
    std::string text;
    for (const Diagnostic& item : diagnostics.items())
      text += (text.empty() ? "" : " ") + std::string(info(item.code).text);
    return text;
  }
  // What a person would read.
  std::string said() const { return render_text(diagnostics, sources); }
  // The text under the first diagnostic's carets.
  std::string underlined() const {
    if (diagnostics.empty()) return {};
    return std::string(sources.text(diagnostics.items().front().primary));
  }
  const sema::Task& task(std::string_view name) const {
    for (const sema::Task& known : model.tasks) {
      if (known.name == name) return known;
    }
    static const sema::Task none;
    return none;
  }
};

inline std::unique_ptr<Analysis> analyze_text(const std::string& text) {
  auto analysis = std::make_unique<Analysis>();
  const FileId id = analysis->sources.add("test.probe", text);
  analysis->files.push_back(syntax::parse(analysis->sources, id, analysis->diagnostics));
  analysis->model = sema::analyze(analysis->sources, {&analysis->files[0].file}, asset_root(),
                                  analysis->diagnostics);
  return analysis;
}

inline std::unique_ptr<Analysis> analyze_with_suite(const std::string& more) {
  return analyze_text(kSmallSuite + more);
}

}  // namespace probe::test
