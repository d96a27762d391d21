// vlaprobe du, vlaprobe gc
#include "runtime/store/room.h"

#include "runtime/base/digit_groups.h"
#include "runtime/base/json.h"
#include "runtime/base/put_words.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/verbs.h"

namespace probe::cli {
namespace {

struct RoomArguments {
  std::vector<std::string> dirs;
  bool json = false, yes = false;
};

int du_verb(const RoomArguments& arguments) {
  Json all = Json::array();
  for (const std::string& dir : arguments.dirs) {
    const auto rooms = store::measure_room(dir);
    if (!rooms) return report(rooms.failure());
    std::int64_t bytes = 0;
    Json parts = Json::array();
    for (const store::Room& room : *rooms) {
      bytes += room.bytes;
      parts.push_back({{"what", room.what}, {"files", room.files}, {"bytes", room.bytes}});
    }
    all.push_back({{"dir", dir}, {"bytes", bytes}, {"parts", std::move(parts)}});
    if (arguments.json) continue;
    put_words("{}: {}\n", dir, store::bytes_text(bytes));
    for (const store::Room& room : *rooms) {
      put_words("  {:<8} {:>8} in {} {}\n", room.what, store::bytes_text(room.bytes),
                digit_groups(static_cast<std::size_t>(room.files)),
                room.files == 1 ? "file" : "files");
    }
  }
  if (arguments.json) put("{}\n", all.dump(1));
  return kFine;
}

int gc_verb(const RoomArguments& arguments) {
  Json all = Json::array();
  std::int64_t bytes = 0;
  for (const std::string& dir : arguments.dirs) {
    const auto found = store::find_spares(dir);
    if (!found) return report(found.failure());
    for (const std::string& note : found->notes) say("note: {}\n", note);
    for (const store::Spare& spare : found->spares) {
      bytes += spare.bytes;
      all.push_back({{"path", spare.path},
                     {"files", spare.files},
                     {"bytes", spare.bytes},
                     {"why", spare.why}});
      if (!arguments.json)
        put_words("{}: {}, {}\n", spare.path, spare.why, store::bytes_text(spare.bytes));
    }
    if (!arguments.yes) continue;
    if (auto removed = store::remove_spares(dir, *found); !removed)
      return report(removed.failure());
  }
  if (arguments.json) put("{}\n", all.dump(1));
  say("{} {}\n", store::bytes_text(bytes),
      arguments.yes ? "are free" : "could be free; --yes removes what is listed");
  return kFine;
}

}  // namespace

void add_du(Verb app, int& exit) {
  auto arguments = std::make_shared<RoomArguments>();
  Verb verb = app.add_subcommand("du", "what a run's folder takes of the disk");
  verb.footer("example: vlaprobe du runs/*");
  verb.add_option("DIR", arguments->dirs, "results folders").required();
  verb.add_flag("--json", arguments->json, "a JSON array");
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = du_verb(*arguments); });
}

void add_gc(Verb app, int& exit) {
  auto arguments = std::make_shared<RoomArguments>();
  Verb verb = app.add_subcommand(
      "gc", "what no row of a run needs: unfinished files, traces without a row, merged shards");
  verb.footer("nothing is removed without --yes\nexample: vlaprobe gc runs/pi0 --yes");
  verb.add_option("DIR", arguments->dirs, "results folders").required();
  verb.add_flag("--yes", arguments->yes, "remove it");
  verb.add_flag("--json", arguments->json, "a JSON array");
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = gc_verb(*arguments); });
}

}  // namespace probe::cli
