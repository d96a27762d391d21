#include "runtime/base/shell_word.h"
#include "runtime/cluster/job_script.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "runtime/base/file.h"
#include "runtime/cluster/program.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::cluster {
namespace {

constexpr const char* kNasty = "it's \"$HOME\" `id` \\ * ; & {port} ü";

// What a shell makes of a word.
std::string said_by_shell(const std::string& word) {
  const auto output = run_program({"bash", "-c", "printf %s " + word});
  REQUIRE(output.ok());
  return output->out;
}

JobScript script_in(const std::string& out) {
  JobScript script;
  script.program = "/opt/vlaprobe/bin/vlaprobe";
  script.plan = out + "/slurm/suite.plan";
  script.out = out;
  script.tasks = 4;
  script.worlds = 8;
  script.policy = "expert";
  script.name = "expert";
  return script;
}

TEST_CASE("a word of a shell is one word, whatever it holds") {
  CHECK(shell_word("runs/a-1.plan") == "runs/a-1.plan");
  CHECK(shell_word("") == "''");
  CHECK(shell_word("it's") == "'it'\\''s'");
  for (const std::string text : {kNasty, "", "a b", "-n", "a\nb", "{a,b}", "~", "#x", "!", "%s"}) {
    CAPTURE(text);
    CHECK(said_by_shell(shell_word(text)) == text);
  }
}

TEST_CASE("the job says how many tasks and CPUs it wants, and passes other options on") {
  JobScript script = script_in("/data/runs/pi0");
  script.sbatch = {"--partition=gpu", "--gres=gpu:1"};
  const auto text = to_text(script);
  REQUIRE_MESSAGE(text.ok(), to_text(text.failure()));
  CHECK(text->starts_with("#!/bin/bash\n# Evaluates shard I of 4 in task I of an array job"));
  for (const char* line : {"#SBATCH --array=1-4\n", "#SBATCH --cpus-per-task=8\n",
                           "#SBATCH --requeue\n", "#SBATCH --partition=gpu\n#SBATCH --gres=gpu:1\n",
                           "#   join:   /opt/vlaprobe/bin/vlaprobe merge /data/runs/pi0/shards/* "
                           "-o /data/runs/pi0\n"}) {
    CHECK_MESSAGE(text->find(line) != std::string::npos, line);
  }
  CHECK(text->find("--exclusive") == std::string::npos);
  CHECK(text->find("server") == std::string::npos);
  script.whole_nodes = true;
  CHECK(to_text(script)->find("#SBATCH --exclusive\n") != std::string::npos);
}

TEST_CASE("a time is asked for once, in whole minutes, and of a server apart in its part") {
  JobScript script = script_in("/out");
  CHECK(to_text(script)->find("--time") == std::string::npos);
  script.time_s = 60 * 60 * 27 + 1;
  CHECK(to_text(script)->find("#SBATCH --time=1-03:01:00\n") != std::string::npos);
  for (const char* other : {"--time=5", "-t5", "-t 5", "--time 5"}) {
    script.sbatch = {other};
    CHECK_MESSAGE(!to_text(script).ok(), other);
  }
  script.sbatch = {"--timeless"};
  CHECK(to_text(script).ok());
  script.server_command = "serve";
  script.server_apart = true;
  script.server_sbatch = {"--gres=gpu:1"};
  script.policy = "openpi://{host}:8000";
  script.sbatch.clear();
  const auto text = to_text(script);
  REQUIRE_MESSAGE(text.ok(), to_text(text.failure()));
  CHECK(text->find("#SBATCH --time=") < text->find("#SBATCH hetjob"));
}

TEST_CASE(
    "the job that joins takes of the options who asks and where, and only shards that began") {
  const run::TemporaryFolder folder;
  const std::string out = folder / "it's a run";
  JobScript script = script_in(out);
  script.sbatch = {"-pgpu", "--account=lab", "--gres=gpu:1", "--exclusive",
                   "-t5",   "--qos low",     "-c4"};
  script.program = "echo";
  const auto text = merge_text(script, true);
  REQUIRE_MESSAGE(text.ok(), to_text(text.failure()));
  for (const char* line : {"#SBATCH -pgpu\n", "#SBATCH --account=lab\n", "#SBATCH --qos low\n"})
    CHECK_MESSAGE(text->find(line) != std::string::npos, *text);
  for (const char* word : {"gres", "exclusive", "-t5", "-c4"})
    CHECK_MESSAGE(text->find(word) == std::string::npos, word);
  std::filesystem::create_directories(out + "/slurm/log");
  for (const char* shard : {"1-of-4", "2-of-4", "3-of-4", "2-of-3"})
    std::filesystem::create_directories(out + "/shards/" + shard);
  for (const char* rows :
       {"1-of-4/results.sqlite", "3-of-4/answers.sqlite", "2-of-3/results.sqlite"})
    std::ofstream(out + "/shards/" + rows);
  CHECK(run_program({"bash", "-c", *text})->status == 0);
  const std::string said = read_file(out + "/slurm/log/merge.txt").value();
  CHECK_MESSAGE(said.find("merge " + out + "/shards/1-of-4 " + out + "/shards/3-of-4 -o " + out +
                          " --mixed-builds\n") != std::string::npos,
                said);
}

TEST_CASE("a server on a node of its own and the worlds are two parts of one job") {
  JobScript script = script_in("/out");
  script.server_command = "serve --port {port}";
  script.server_sbatch = {"--gres=gpu:1"};
  script.server_apart = true;
  script.policy = "openpi://{host}:{port}";
  script.sbatch = {"--partition=cpu"};
  const auto text = to_text(script);
  REQUIRE_MESSAGE(text.ok(), to_text(text.failure()));
  const auto gpu = text->find("#SBATCH --gres=gpu:1\n"), parts = text->find("#SBATCH hetjob\n");
  const auto tasks = text->find("#SBATCH --ntasks=4\n"), cpu = text->find("#SBATCH --partition=cpu\n");
  CHECK(gpu < parts);
  CHECK(parts < tasks);
  CHECK(tasks < cpu);
  CHECK(cpu != std::string::npos);
  CHECK(text->find("--array") == std::string::npos);
  const auto refusal = [&](auto&& change) {
    JobScript other = script;
    change(other);
    const auto refused = to_text(other);
    return refused.ok() ? std::string() : to_text(refused.failure());
  };
  CHECK(refusal([](JobScript& s) { s.policy = "openpi://127.0.0.1:{port}"; }).find("write `{host}`") !=
        std::string::npos);
  CHECK(refusal([](JobScript& s) { s.server_apart = false; }).find("--server-sbatch asks for") !=
        std::string::npos);
  CHECK(refusal([](JobScript& s) {
          s.server_command.clear();
          s.policy = "null";
        }).find("--server-command starts") != std::string::npos);
}

TEST_CASE("an option's value is one word for sbatch, whatever it holds") {
  JobScript script = script_in("/out");
  for (const auto& [option, line] : {
           std::pair{"--comment=a b", "--comment=\"a b\""},
           std::pair{"--comment a  b", "--comment \"a  b\""},
           std::pair{"--comment=#1", "--comment=\"#1\""},
           std::pair{"--comment=it's", "--comment=\"it's\""},
           std::pair{"--comment=say \"hi\" \\o/", "--comment=\"say \\\"hi\\\" \\\\o/\""},
           std::pair{"--comment=", "--comment=\"\""},
           std::pair{"-p gpu", "-p gpu"},
           std::pair{"-J two words", "-J \"two words\""},
           std::pair{"-Jtwo words", "-J\"two words\""},
           std::pair{"--exclusive", "--exclusive"},
           std::pair{"--gres=gpu:1", "--gres=gpu:1"},
       }) {
    script.sbatch = {option};
    const auto text = to_text(script);
    REQUIRE_MESSAGE(text.ok(), to_text(text.failure()));
    CHECK_MESSAGE(text->find("#SBATCH " + std::string(line) + "\n") != std::string::npos, line);
  }
}

TEST_CASE("what no job could do is refused") {
  JobScript script = script_in("/out");
  const auto refusal = [&] {
    const auto text = to_text(script);
    REQUIRE_FALSE(text.ok());
    CHECK(text.failure().code == Fault::kUsage);
    return to_text(text.failure());
  };
  script.policy = "openpi://127.0.0.1:{port}";
  CHECK(refusal().starts_with("--policy: `{port}` is the port of a server"));
  script.server_command = "serve\n--port {port}";
  CHECK(refusal() == "--server-command: the command is one line");
  script.server_command = "serve --port {port}";
  script.sbatch = {"gpu"};
  CHECK(refusal() == "--sbatch: `gpu` is not one option, as --partition=gpu is");
  for (const char* broken : {"--comment=a\nrm", "--comment=a\r#SBATCH --x"}) {
    script.sbatch = {broken};
    CHECK_FALSE(to_text(script).ok());
  }
  script.sbatch.clear();
  script.out = "/a\nb";
  CHECK_FALSE(to_text(script).ok());
}

// A job as Slurm would start it, with a program in place of vlaprobe that says how it was called.
struct Job {
  run::TemporaryFolder folder;
  JobScript script;
  Job() : script(script_in(folder / "it's here")) {
    std::filesystem::create_directories(script.out + "/slurm/log");
    script.program = folder / "fake vlaprobe";
  }
  void program(const std::string& body) {
    std::ofstream(script.program) << "#!/bin/bash\n" << body;
    std::filesystem::permissions(script.program, std::filesystem::perms::owner_all);
  }
  ProgramOutput start() {
    const auto text = to_text(script);
    REQUIRE_MESSAGE(text.ok(), to_text(text.failure()));
    std::ofstream(folder / "job.sh") << *text;
    const auto output =
        run_program({"env", "SLURM_ARRAY_TASK_ID=2", "SLURM_JOB_ID=17", "bash", folder / "job.sh"});
    REQUIRE(output.ok());
    return *output;
  }
  std::string log() { return read_file(script.out + "/slurm/log/2.txt").value(); }
};

TEST_CASE("a task runs its shard with the words that were given, whatever they hold") {
  Job job;
  job.program("printf '<%s>' \"$@\"\n");
  job.script.policy = job.script.name = "replay of it's";
  job.script.run_arguments = {"--tasks", "a b*"};
  CHECK(job.start().status == 0);
  CHECK(job.log().ends_with("<run><" + job.script.plan + "><--name><replay of it's><--jobs><8>" +
                            "<--tasks><a b*><-o><" + job.script.out +
                            "/shards/2-of-4><--shard><2/4><--policy><replay of it's>"));
}

TEST_CASE("a task's server is started on a free port, waited for and ended with all it started") {
  Job job;
  // The server's child would outlive it if only the shell were ended.
  job.script.server_command =
      "/usr/bin/python3 -m http.server --bind 127.0.0.1 {port} & echo $! >" +
      shell_word(job.folder / "child") + "; wait";
  job.script.policy = "openpi://127.0.0.1:{port}?profile=a";
  job.script.name = kNasty;
  job.program(
      "echo \"$5 ${!#}\" >>\"$0.calls\"\n"
      "port=${!#}; port=${port##*127.0.0.1:}; port=${port%%\\?*}\n"
      "exec 3<>/dev/tcp/127.0.0.1/$port && kill -0 $(cat \"${0%/*}/child\") && exit 5\n");
  CHECK(job.start().status == 5);
  const std::string calls = read_file(job.script.program + ".calls").value();
  CHECK(calls.find(kNasty) == std::string::npos);  // it is word 4
  CHECK(calls.find("openpi://127.0.0.1:") != std::string::npos);
  CHECK(calls.find("?profile=a") != std::string::npos);
  const std::string child = read_file(job.folder / "child").value();
  CHECK(run_program({"bash", "-c", "kill -0 " + child})->status != 0);
}

TEST_CASE("a task whose server dies tries again with another, three times in all") {
  Job job;
  job.script.server_command = "/usr/bin/python3 -m http.server --bind 127.0.0.1 {port}";
  job.script.policy = "openpi://127.0.0.1:{port}";
  job.program("echo call >>\"$0.calls\"; exit 2\n");
  CHECK(job.start().status == 2);
  CHECK(read_file(job.script.program + ".calls").value() == "call\ncall\ncall\n");
  job.script.server_command = "exit 1";
  CHECK(job.start().status == 2);
  CHECK(job.log().find("the server ended before it answered") != std::string::npos);
  job.script.server_command = "sleep 100";
  job.script.server_wait_s = 0;
  CHECK(job.start().status == 2);
  CHECK(job.log().find("the server did not answer within 0 s") != std::string::npos);
}

TEST_CASE("a program's outputs and exit code come back, and one that is absent is named") {
  const auto output = run_program({"bash", "-c", "echo out; echo err >&2; exit 3"});
  REQUIRE(output.ok());
  CHECK(output->out == "out\n");
  CHECK(output->err == "err\n");
  CHECK(output->status == 3);
  CHECK(run_program({"bash", "-c", "kill -9 $$"})->status == 128 + 9);
  CHECK(run_program({"vlaprobe-no-such-program"}).failure().where == "vlaprobe-no-such-program");
}

}  // namespace
}  // namespace probe::cluster
