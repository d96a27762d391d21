// Manifests for Kubernetes, held to the API's own schemas.
#include "runtime/cluster/kubernetes.h"

#include <doctest/doctest.h>

#include <span>

#include "runtime/base/file.h"
#include "runtime/base/json.h"
#include "tests/node_program.h"
#include "tests/runtime/run/table_plan.h"
#include "tests/runtime/run/temporary_folder.h"

namespace probe::cluster {
namespace {

KubernetesJob job_of() {
  KubernetesJob job;
  job.image = "registry/vlaprobe:0.1.0";
  job.claim = "runs";
  job.folder = "pi0";
  job.tasks = 3;
  job.worlds = 4;
  job.policy = "openpi://127.0.0.1:8000?profile=pi0_bridge";
  job.row_name = "\"pi0\": $(all) #1";
  job.run_arguments = {"--tasks", "carrot_*"};
  job.server_image = "registry/pi0:1";
  job.server_command = {"serve", "--port", "8000"};
  job.gpus = 1;
  return job;
}

TEST_CASE("an Indexed Job and its merge fit the API, and say what each shard runs") {
  const run::TemporaryFolder folder;
  const plan::Plan plan = run::table_plan(4, 6);
  const KubernetesJob job = job_of();
  const auto shards = job_manifest(job, plan), merge = merge_manifest(job);
  REQUIRE_MESSAGE(shards.ok(), to_text(shards.failure()));
  REQUIRE(merge.ok());
  REQUIRE(write_file(folder / "job.yaml", std::as_bytes(std::span(*shards))).ok());
  REQUIRE(write_file(folder / "merge.yaml", std::as_bytes(std::span(*merge))).ok());
  const test::ShellOutcome said = test::run_node(
      "tests/outside/check_ci.mjs", "'" VLAPROBE_BINARY_DIR "/outside/node_modules' k8s '" +
                                        folder.path + "/job.yaml' '" + folder.path + "/merge.yaml'");
  REQUIRE_MESSAGE(said.status == 0, said.words);
  const auto end = said.words.find('\n');
  const Json documents = Json::parse(said.words.substr(0, end));
  const Json merging = Json::parse(said.words.substr(end + 1));
  CHECK(documents[0]["kind"] == "ConfigMap");
  const Json& spec = documents[1]["spec"];
  CHECK(spec["completionMode"] == "Indexed");
  CHECK(spec["completions"] == 3);
  const Json& pod = spec["template"]["spec"];
  const auto words = pod["containers"][0]["command"].get<std::vector<std::string>>();
  const std::vector<std::string> wanted = {"/opt/vlaprobe/bin/vlaprobe",
                                           "run",
                                           "/plan/suite.plan",
                                           "--shard",
                                           "@$(SHARD)/3",
                                           "-o",
                                           "/runs/pi0/shards/$(SHARD)-of-3",
                                           "--policy",
                                           job.policy,
                                           "--name",
                                           "\"pi0\": $$(all) #1",
                                           "--jobs",
                                           "4",
                                           "--tasks",
                                           "carrot_*"};
  CHECK(words == wanted);
  CHECK(pod["initContainers"][0]["restartPolicy"] == "Always");
  CHECK(merging[0]["spec"]["template"]["spec"]["containers"][0]["command"].size() == 7);
}

TEST_CASE("without a server a pod has worlds alone") {
  KubernetesJob job = job_of();
  job.server_image.clear();
  job.server_command.clear();
  const auto text = job_manifest(job, run::table_plan(4, 6));
  REQUIRE(text.ok());
  CHECK(text->find("initContainers") == std::string::npos);
}

TEST_CASE("what the API would refuse is refused here, by its flag") {
  const auto where = [](auto change) {
    KubernetesJob job = job_of();
    change(job);
    const auto text = merge_manifest(job);
    return text ? std::string() : text.failure().where;
  };
  CHECK(where([](KubernetesJob& job) { job.name = "Big"; }) == "--job-name");
  CHECK(where([](KubernetesJob& job) { job.name = std::string(41, 'a'); }) == "--job-name");
  CHECK(where([](KubernetesJob& job) { job.image = ""; }) == "--image");
  CHECK(where([](KubernetesJob& job) { job.claim = "my_runs"; }) == "--claim");
  CHECK(where([](KubernetesJob& job) { job.folder = "../up"; }) == "-o");
  CHECK(where([](KubernetesJob& job) { job.server_image = ""; }) == "--server-command");
}

}  // namespace
}  // namespace probe::cluster
