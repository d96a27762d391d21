// The script is for people too: they read it before they submit it.
#include "runtime/cluster/job_script.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/base/shell_word.h"

namespace probe::cluster {
namespace {

constexpr std::string_view kPort = "{port}", kHost = "{host}";

Failure usage(const std::string& message, const char* where) {
  return {Fault::kUsage, message, where};
}

// Output goes to a log by the script itself: file names in #SBATCH lines have a quoting of their
// own.
constexpr const char* kHead = R"sh(#SBATCH --nodes=1
#SBATCH --ntasks=1
#SBATCH --requeue
#SBATCH --output=/dev/null
)sh";

// What each shard does, of a job whose server is elsewhere: this script once more, started by srun.
constexpr const char* kTask = R"sh(
if [ "${1-}" = shard ]; then
  shard=$((SLURM_PROCID + 1))
  exec >>"$out/slurm/log/$shard.txt" 2>&1
  echo "shard $shard of $shards: job $SLURM_JOB_ID on $(hostname), $(date '+%F %T')"
  exec "${run[@]}" -o "$out/shards/$shard-of-$shards" --shard "$shard/$shards" @flag "$2"
fi
exec >>"$out/slurm/log/job.txt" 2>&1
echo "$shards shards: job $SLURM_JOB_ID, server on $(hostname), $(date '+%F %T')"
)sh";

constexpr const char* kLog = R"sh(
shard=$SLURM_ARRAY_TASK_ID
exec >>"$out/slurm/log/$shard.txt" 2>&1
echo "shard $shard of $shards: job $SLURM_JOB_ID on $(hostname), $(date '+%F %T')"
)sh";

// A task without a server of its own needs no second try: `run` has its own.
constexpr const char* kWorldsOnly = R"sh(
exec "${run[@]}" -o "$out/shards/$shard-of-$shards" --shard "$shard/$shards" @flag "$policy"
)sh";

constexpr const char* kServer = R"sh(
is_open() { (exec 3<>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }

# A port that nobody listens on, below those that the system gives to connections; tasks on one
# machine begin to look at different places.
find_port() {
  port=$((20000 + (SLURM_JOB_ID * 97 + $1 * 7) % 12000))
  while is_open "$port"; do port=$((port + 1)); done
}

# The server gets a process group of its own, so that all of it can be ended.
server=
stop_server() {
  [ -z "$server" ] && return
  kill -TERM -- "-$server" 2>/dev/null
  for _ in {1..50}; do kill -0 -- "-$server" 2>/dev/null || break; sleep 0.1; done
  kill -KILL -- "-$server" 2>/dev/null
  wait "$server" 2>/dev/null
  server=
}
trap stop_server EXIT
trap 'exit 143' TERM INT

start_server() {
  echo "server on port $port: ${server_command//\{port\}/$port}"
  PORT=$port setsid bash -c "${server_command//\{port\}/$port}" &
  server=$!
  local from=$SECONDS
  until is_open "$port"; do
    if ! kill -0 "$server" 2>/dev/null; then
      echo "the server ended before it answered"
      return 1
    fi
    if ((SECONDS - from > server_wait)); then
      echo "the server did not answer within $server_wait s"
      return 1
    fi
    sleep 0.5
  done
}
)sh";

// With kAsk or kAskApart in the place of @ask.
constexpr const char* kWithServer = R"sh(
# Exit code 2 is the outside, such as a server that died: what is stored stays, the rest is tried
# again with a new server.
status=2
for attempt in 1 2 3; do
  find_port "$attempt"
  if start_server; then
    asked=${policy//\{port\}/$port}
    @ask
    status=$?
    [ "$status" -ne 2 ] && break
  fi
  stop_server
done
exit "$status"
)sh";

constexpr const char* kAsk =
    R"sh("${run[@]}" -o "$out/shards/$shard-of-$shards" --shard "$shard/$shards" @flag "$asked")sh";

constexpr const char* kAskApart = R"sh(# A shard that fails does not end the others.
    srun --het-group=1 --cpus-per-task="$worlds" --kill-on-bad-exit=0 --wait=0 --output=/dev/null \
      bash "$out/slurm/job.sh" shard "${asked//\{host\}/$(hostname)}")sh";

bool has_line_break(std::string_view text) {
  return text.find_first_of("\n\r") != std::string_view::npos;
}

// One word of a #SBATCH line. sbatch ends a word at a blank outside quotes and takes the rest after
// `#` for a comment; unlike in a shell, a backslash counts inside both kinds of quotes.
std::string sbatch_word(std::string_view text) {
  if (!text.empty() && text.find_first_of(" \t\v\f\"'\\#") == std::string_view::npos) {
    return std::string(text);
  }
  std::string word = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') word += '\\';
    word += c;
  }
  return word + "\"";
}

// An option as it is given, `--name=value`, `--name value`, `-n value` or `-nvalue`, for a #SBATCH
// line: all of the value is one word.
std::string sbatch_option(std::string_view option) {
  constexpr std::size_t kShortName = 2;
  std::size_t end = option.starts_with("--") ? option.find_first_of("= ") : kShortName;
  if (end >= option.size()) return sbatch_word(option);
  std::size_t value = option.find_first_not_of(' ', end);
  if (value == std::string_view::npos) return sbatch_word(option.substr(0, end));
  if (option[end] == '=') value = ++end;
  return sbatch_word(option.substr(0, end)) + (option[end - 1] != '=' && value > end ? " " : "") +
         sbatch_word(option.substr(value));
}

// An option's name in full, "--time" of "-t5"; of a short one that stands here for nothing, itself.
std::string_view long_name(std::string_view option) {
  constexpr std::pair<std::string_view, std::string_view> kNames[] = {
      {"-A", "--account"},   {"-C", "--constraint"}, {"-M", "--clusters"},
      {"-p", "--partition"}, {"-q", "--qos"},        {"-t", "--time"},
  };
  if (option.starts_with("--")) return option.substr(0, option.find_first_of("= "));
  for (const auto& [brief, full] : kNames) {
    if (option.starts_with(brief)) return full;
  }
  return option.substr(0, 2);
}

Status add_options(std::string& text, const std::vector<std::string>& options, const char* flag) {
  for (const std::string& option : options) {
    if (has_line_break(option) || !option.starts_with("-"))
      return usage("`" + option + "` is not one option, as --partition=gpu is", flag);
    text += "#SBATCH " + sbatch_option(option) + "\n";
  }
  return {};
}

bool says_time(const std::string& option) {
  const std::string_view name = long_name(option);
  return name == "--time" || name == "--tim";  // sbatch takes what begins no other option
}

// "1-02:30:00", whole minutes.
std::string time_text(std::int64_t seconds) {
  const std::int64_t minutes = (seconds + 59) / 60;
  const std::int64_t days = minutes / (24 * 60);
  return (days > 0 ? fmt::format("{}-", days) : "") +
         fmt::format("{:02}:{:02}:00", minutes / 60 % 24, minutes % 60);
}

}  // namespace

std::string shard_folder(int shard, int shards) {
  return "shards/" + std::to_string(shard) + "-of-" + std::to_string(shards);
}

Result<std::string> to_text(const JobScript& script) {
  const bool has_server = !script.server_command.empty();
  if (!has_server && script.policy.find(kPort) != std::string::npos) {
    return usage("`{port}` is the port of a server that --server-command starts, and there is none",
                 script.actor_flag.c_str());
  }
  if (!has_server && script.server_apart)
    return usage("is of a server, which --server-command starts", "--server-sbatch");
  const bool has_host = script.policy.find(kHost) != std::string::npos;
  if (script.server_apart && !has_host) {
    return usage("the server has a node of its own: write `{host}` in place of this machine's address",
                 script.actor_flag.c_str());
  }
  if (!script.server_apart && has_host) {
    return usage("`{host}` is the node of a server that --server-sbatch asks for, and there is none",
                 script.actor_flag.c_str());
  }
  if (has_line_break(script.server_command)) {
    return usage("the command is one line", "--server-command");
  }
  if (has_line_break(script.out) || has_line_break(script.program)) {
    return usage("a path with a line break cannot be written into a job", "-o");
  }
  const std::string tasks = std::to_string(script.tasks);
  std::string text = "#!/bin/bash\n";
  text += script.server_apart
              ? "# Evaluates " + tasks +
                    " shards, all asking one server that has a node of its own; a job that runs "
                    "again continues them.\n"
              : "# Evaluates shard I of " + tasks +
                    " in task I of an array job; a task that runs again continues its shard.\n";
  text += "#   submit: sbatch " + shell_word(script.out + "/slurm/job.sh") + "\n";
  text += "#   join:   " + shell_word(script.program) + " merge " + shell_word(script.out) +
          "/shards/* -o " + shell_word(script.out) + "\n";
  text += "#SBATCH --job-name=vlaprobe\n";
  if (script.time_s > 0 && (std::ranges::any_of(script.sbatch, says_time) ||
                            std::ranges::any_of(script.server_sbatch, says_time)))
    return usage("says how much time a task has, and --time-from does, too", "--sbatch");
  // A heterogeneous job has the time of its first part.
  const std::string time =
      script.time_s > 0 ? "#SBATCH --time=" + time_text(script.time_s) + "\n" : "";
  if (script.server_apart) {
    text += kHead + time;
    PROBE_TRY(add_options(text, script.server_sbatch, "--server-sbatch"));
    text += "#SBATCH hetjob\n#SBATCH --ntasks=" + tasks + "\n#SBATCH --requeue\n";
    if (script.whole_nodes) text += "#SBATCH --ntasks-per-node=1\n";
  } else {
    text += "#SBATCH --array=1-" + tasks + "\n";
    text += kHead + time;
  }
  text += "#SBATCH --cpus-per-task=" + std::to_string(script.worlds) + "\n";
  if (script.whole_nodes) text += "#SBATCH --exclusive\n";
  PROBE_TRY(add_options(text, script.sbatch, "--sbatch"));
  text += "\nout=" + shell_word(script.out) + "\n";
  text += "shards=" + std::to_string(script.tasks) + "\n";
  if (script.server_apart) text += "worlds=" + std::to_string(script.worlds) + "\n";
  text += "policy=" + shell_word(script.policy) + "\n";
  if (has_server) {
    text += "server_command=" + shell_word(script.server_command) + "\n";
    text += "server_wait=" + std::to_string(script.server_wait_s) + "  # seconds\n";
  }
  text += "run=(" + shell_word(script.program) + " " + script.verb + " " + shell_word(script.plan) +
          " --name " + shell_word(script.name) + " --jobs " + std::to_string(script.worlds);
  for (const std::string& word : script.run_arguments) text += " " + shell_word(word);
  text += ")\n";
  std::string body = std::string(script.server_apart ? kTask : kLog) +
                     (has_server ? std::string(kServer) + kWithServer : kWorldsOnly);
  const auto fill = [&](std::string_view place, std::string_view with) {
    const auto at = body.find(place);
    if (at != body.npos) body.replace(at, place.size(), with);
  };
  fill("@ask", script.server_apart ? kAskApart : kAsk);
  fill("@flag", script.actor_flag);
  text += body;
  return text;
}

Result<std::string> merge_text(const JobScript& script, bool mixed_builds) {
  std::vector<std::string> options = script.sbatch;
  std::erase_if(options, [](const std::string& option) {
    constexpr std::string_view kOfWhom[] = {"--account",   "--clusters", "--constraint",
                                            "--partition", "--qos",      "--reservation",
                                            "--wckey"};
    return std::ranges::find(kOfWhom, long_name(option)) == std::end(kOfWhom);
  });
  std::string text =
      "#!/bin/bash\n# Joins the shards that there are, when the job of the shards has ended.\n"
      "#SBATCH --job-name=vlaprobe-merge\n";
  text += kHead;
  PROBE_TRY(add_options(text, options, "--sbatch"));
  const std::string out = shell_word(script.out);
  text += "\nout=" + out + "\nexec >>\"$out/slurm/log/merge.txt\" 2>&1\n";
  text += "echo \"job $SLURM_JOB_ID on $(hostname), $(date '+%F %T')\"\n";
  text += "begun=()\nfor rows in \"$out\"/shards/*-of-" + std::to_string(script.tasks) +
          "/*.sqlite; do [ -e \"$rows\" ] && begun+=(\"${rows%/*}\"); done\n";
  text +=
      "if [ ${#begun[@]} -eq 0 ]; then echo \"no shard has begun: $out/slurm/log has what each "
      "said\"; exit 1; fi\n";
  text += "exec " + shell_word(script.program) + " merge \"${begun[@]}\" -o \"$out\"" +
          (mixed_builds ? " --mixed-builds" : "") + "\n";
  return text;
}

}  // namespace probe::cluster
