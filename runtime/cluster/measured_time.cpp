#include "runtime/cluster/measured_time.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "runtime/base/paths.h"
#include "runtime/store/store.h"

namespace probe::cluster {

Result<MeasuredTime> measured_time(const std::string& dir) {
  namespace fs = std::filesystem;
  MeasuredTime time;
  double spent = 0;  // s, of all worlds
  const auto add = [&](const std::string& folder) -> Status {
    PROBE_ASSIGN(const auto record, store::find_run_record(folder));
    if (!record) return {};
    PROBE_ASSIGN(const auto calls, store::read_run_calls(folder));
    for (const store::RunCall& call : calls) {
      if (!call.ended || call.episodes <= 0) continue;
      spent += call.elapsed_s * call.worlds;
      time.episodes += call.episodes;
      time.worlds = std::max(time.worlds, call.worlds);
    }
    return {};
  };
  PROBE_TRY(add(dir));
  std::error_code error;
  if (time.episodes == 0) {
    for (const auto& shard : fs::directory_iterator(fs::path(dir) / "shards", error))
      PROBE_TRY(add(shard.path().string()));
  }
  if (time.episodes == 0) {
    return Failure{
        Fault::kUsage,
        !is_there(dir)
            ? dir + " is not there"
            : dir +
                  " holds no call of `run` that ended with an episode: run some first, as "
                  "`vlaprobe run F .. --episodes 0-0 -o trial` does, and name that folder",
        "--time-from"};
  }
  time.seconds = spent / time.episodes;
  return time;
}

double time_for(const MeasuredTime& measured, std::int64_t episodes, int worlds) {
  const std::int64_t rounds = (episodes + worlds - 1) / worlds;
  return 1.5 * measured.seconds * static_cast<double>(rounds);
}

}  // namespace probe::cluster
