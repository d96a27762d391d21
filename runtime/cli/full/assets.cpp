// vlaprobe assets import, vlaprobe assets pack, vlaprobe assets mujoco
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

#include "runtime/assets/import.h"
#include "runtime/assets/mujoco_folder.h"
#include "runtime/assets/pack.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/put_words.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/verbs.h"

namespace probe::cli {
namespace {

constexpr double kUnsaid = std::numeric_limits<double>::quiet_NaN();

struct AssetsArguments {
  assets::ImportOptions options;
  std::string suite = "intact";
  bool fill = false;
};

int import_verb(AssetsArguments& arguments) {
  const bool is_google = arguments.suite == "google";
  if (!is_google && arguments.suite != "intact") {
    return report(Failure{Fault::kUsage,
                          fmt::format("--for takes intact or google, found `{}`", arguments.suite),
                          ""});
  }
  if (is_google) arguments.options.suite = assets::ImportFor::kGoogle;
  if (arguments.fill || is_google) {
    auto own = find_asset_root();
    if (!own) return report(own.failure());
    if (arguments.fill) arguments.options.fill_from = own->folders().front();
    if (is_google) arguments.options.own = own->folders();
  }
  auto imported = assets::import_data(arguments.options);
  if (!imported) return report(imported.failure());
  std::map<assets::Verdict, std::size_t> counts;
  for (const assets::ImportLine& line : imported->lines) {
    ++counts[line.verdict];
    put_words("{:<8} {}  {}\n", assets::to_word(line.verdict), line.name, line.text);
  }
  using enum assets::Verdict;
  const std::string own =
      counts[kOwn] == 0 ? "" : fmt::format(", {} the suite's own", counts[kOwn]);
  say("{}: {} taken, {} odd, {} missing, {} filled in{}; {} files, {:.1f} MB\n",
      arguments.options.to, counts[kTaken], counts[kOdd], counts[kMissing], counts[kFilled], own,
      imported->files, static_cast<double>(imported->bytes) / 1e6);
  say("next: vlaprobe check suite/{}.probe --assets {}\n", arguments.suite, arguments.options.to);
  return kFine;
}

void add_pack(Verb assets, int& exit) {
  auto options = std::make_shared<assets::PackOptions>();
  options->scale = kUnsaid;
  Verb pack = assets.add_subcommand("pack", "a mesh or a robot of yours as one asset");
  pack.footer(
      "reads glb, gltf, dae, obj, stl, urdf; z is up in the result; prints the box to write\n"
      "example: vlaprobe assets pack mug/mug.obj -o assets/objects/mug --scale 0.001");
  pack.add_option("FILE", options->from, "mesh or URDF").required();
  pack.add_option("-o,--out", options->to, "folder to make").required();
  pack.add_option("--scale", options->scale, "metres a unit of the file (default: 1)");
  pack.add_option("--collision", options->collision,
                  "mesh of convex parts (default: collision.* beside FILE, else FILE itself)");
  pack.add_option("--up", options->up, "axis of an obj or stl that points up (default: z)");
  pack.add_flag("--hollow", options->hollow,
                "what is felt leaves the inside of a cup, bowl or tray free");
  pack.refuse_empty_values();
  pack.callback([options, &exit] {
    if (std::isnan(options->scale)) {
      options->scale = 1;
      options->refuses_odd_size = true;
    }
    const auto packed = assets::pack_asset(*options);
    if (!packed) {
      exit = report(packed.failure());
      return;
    }
    put_words("{}: {}\n", options->to, packed->made);
    for (const std::string& doubt : packed->doubts) say("note: {}\n", doubt);
    if (!packed->text.empty()) put("{}", packed->text);
    if (!packed->found.empty()) say("note: {}\n", packed->found);
    exit = kFine;
  });
}

void add_mujoco(Verb assets, int& exit) {
  struct Arguments {
    assets::MujocoFolderOptions options;
    bool object = false, fixture = false, backdrop = false;
  };
  auto arguments = std::make_shared<Arguments>();
  Verb verb =
      assets.add_subcommand("mujoco", "objects and fixtures of MuJoCo (MJCF) as assets and text");
  verb.footer(
      "writes objects/, fixtures/ or scenes/, and a NAME.probe that declares each object and "
      "fixture;\n"
      "a line for each thing that is odd or not read, with file and line\n"
      "example: vlaprobe assets mujoco mug/mug.xml -o mine --merged-into "
      "robosuite/models/assets/base.xml");
  assets::MujocoFolderOptions& options = arguments->options;
  verb.add_option("FILE", options.files, "MJCF of one object or fixture each").required();
  verb.add_option("-o,--out", options.to, "asset folder to make").required();
  verb.add_option("--name", options.name,
                  "what one FILE's object is declared as (default: the file's stem)");
  verb.add_option(
      "--merged-into", options.merged_into,
      "the MJCF that FILE is made a part of (robosuite's base.xml): its compiler holds");
  verb.add_flag("--object", arguments->object,
                "what is picked up (default, where no joint is in it)");
  verb.add_flag("--fixture", arguments->fixture, "what stands (default, where a joint is in it)");
  verb.add_flag("--backdrop", arguments->backdrop,
                "what is only seen: everything that stands in the world");
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] {
    using Kind = assets::MujocoKind;
    assets::MujocoFolderOptions& chosen = arguments->options;
    if (arguments->object + arguments->fixture + arguments->backdrop > 1) {
      exit = report(
          {Fault::kUsage, "--object, --fixture and --backdrop are three kinds of one thing", ""});
      return;
    }
    if (arguments->object) chosen.kind = Kind::kObject;
    if (arguments->fixture) chosen.kind = Kind::kFixture;
    if (arguments->backdrop) chosen.kind = Kind::kBackdrop;
    const auto made = assets::make_mujoco_folder(chosen);
    if (!made) {
      exit = report(made.failure());
      return;
    }
    for (const assets::MujocoLine& line : made->lines)
      put_words("{:<8} {}\n", line.word, line.text);
    say("{}: {} files, {:.1f} MB\n", chosen.to, made->files,
        static_cast<double>(made->bytes) / 1e6);
    exit = kFine;
  });
}

}  // namespace

void add_assets(Verb app, int& exit) {
  auto arguments = std::make_shared<AssetsArguments>();
  Verb verb = app.add_subcommand("assets", "asset folders of your own");
  verb.require_subcommand();
  Verb import = verb.add_subcommand(
      "import", "a SimplerEnv / ManiSkill2_real2sim data folder as an asset folder");
  import.footer(
      "one line a model: taken, odd (taken, with a remark) or missing; every verb takes the result "
      "with --assets\n"
      "example: vlaprobe assets import SimplerEnv/ManiSkill2_real2sim -o simpler");
  import.add_option("DIR", arguments->options.from, "the repository, its data folder, or above")
      .required();
  import.add_option("-o,--out", arguments->options.to, "folder to make").required();
  import.add_option("--for", arguments->suite,
                    "suite whose tasks the models are for, intact (default) or google");
  import.add_flag("--fill", arguments->fill,
                  "take what the suite needs and DIR lacks from vlaprobe's own assets");
  import.refuse_empty_values();
  import.callback([arguments, &exit] { exit = import_verb(*arguments);
});
add_pack(verb, exit);
add_mujoco(verb, exit);
}  // namespace probe::cli

}  // namespace probe::cli
