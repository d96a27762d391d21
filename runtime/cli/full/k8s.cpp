// vlaprobe k8s
#include "runtime/cluster/kubernetes.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/base/folder_kind.h"
#include "runtime/base/inside.h"
#include "runtime/base/paths.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/run_options.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/cluster/run_words.h"

namespace probe::cli {
namespace {

struct KubernetesArguments {
  RunArguments run;
  cluster::KubernetesJob job;
};

Status write(const std::string& out, const std::string& below, const std::string& text) {
  PROBE_ASSIGN(const std::string file, file_inside(out, below));
  return write_file(file, std::as_bytes(std::span(text)));
}

// "`objects/mug` and 2 more lie in `my/models`": what the program has not itself.
std::string models_of_here(const plan::Plan& plan, const AssetRoot& assets) {
  const auto found = find_asset_root();
  const std::vector<std::string> own = found ? found->folders() : std::vector<std::string>();
  std::set<std::string> models;
  std::string folder;
  for (const plan::AssetRecord& asset : plan.assets()) {
    const std::string path(plan.text(asset.path));
    const std::string& holder = assets.holder(path);
    if (std::ranges::find(own, holder) != own.end()) continue;
    if (folder.empty()) folder = holder;
    if (holder == folder) models.insert(path.substr(0, path.find('/', path.find('/') + 1)));
  }
  if (models.empty()) return "its models lie in " + assets.text();
  const std::size_t more = models.size() - 1;
  return "`" + *models.begin() + "`" + (more > 0 ? " and " + std::to_string(more) + " more lie" : " lies") +
         " in `" + folder + "`";
}

Status write_manifests(KubernetesArguments& arguments, const run::RunOptions& options,
                       const plan::Plan& plan) {
  cluster::KubernetesJob& job = arguments.job;
  if (!options.assets.empty()) {
    return Failure{Fault::kUsage,
                   models_of_here(plan, options.assets) +
                       " on this machine, and the image has its own assets alone; `vlaprobe slurm` and "
                       "`run` take the folders of this machine",
                   arguments.run.file};
  }
  // Every shard would refuse what one does.
  if (auto actor = run::choose_actor(options); !actor) return actor.failure();
  job.policy = options.policy;
  job.row_name = options.name.empty() ? options.policy : options.name;
  job.worlds = options.jobs;
  job.folder = std::filesystem::path(absolute_path(options.out)).filename().string();
  job.run_arguments = cluster::run_words(options);
  PROBE_ASSIGN(const std::string shards, cluster::job_manifest(job, plan));
  PROBE_ASSIGN(const std::string merge, cluster::merge_manifest(job));
  PROBE_TRY(check_holds_no_other(options.out, FolderKind::kRun));
  const std::string folder = options.out + "/k8s";
  PROBE_TRY(check_inside(options.out, "k8s"));
  PROBE_TRY(make_folders(folder));
  PROBE_TRY(write(options.out, "k8s/job.yaml", shards));
  PROBE_TRY(write(options.out, "k8s/merge.yaml", merge));
  say("{0}/job.yaml: {1} shards; kubectl apply -f {0}/job.yaml, and behind it {0}/merge.yaml\n",
      folder, job.tasks);
  return {};
}

int k8s_verb(KubernetesArguments& arguments) {
  auto options = to_options(arguments.run);
  if (!options) return report(options.failure());
  const LoadedPlan loaded = load_runnable(arguments.run);
  if (!loaded.plan) return loaded.exit;
  options->assets = loaded.assets;
  const Status written = write_manifests(arguments, *options, *loaded.plan);
  return written ? kFine : report(written.failure());
}

}  // namespace

void add_k8s(Verb app, int& exit) {
  auto arguments = std::make_shared<KubernetesArguments>();
  cluster::KubernetesJob& job = arguments->job;
  Verb verb = app.add_subcommand("k8s", "`run` as an Indexed Job of Kubernetes, and its merge");
  verb.footer(
      "-o holds k8s/job.yaml and k8s/merge.yaml; its last name is the folder in the claim.\n"
      "example: vlaprobe k8s suite/intact.probe --array 8 --jobs 4 -o runs/pi0 --claim runs \\\n"
      "           --image registry/vlaprobe:0.1.0 --policy openpi://127.0.0.1:8000 \\\n"
      "           --server-image registry/pi0:1 --gpus 1");
  add_run_options(verb, arguments->run);
  verb.add_option("--array", job.tasks, "N shards, a pod each").required().between(1, 100000);
  verb.add_option("--image", job.image, "with vlaprobe, as `.ci/package oci` makes it").required();
  verb.add_option("--claim", job.claim, "PersistentVolumeClaim that all nodes can write").required();
  verb.add_option("--job-name", job.name, "of the Job (vlaprobe)");
  verb.add_option("--memory", job.memory, "of each pod's worlds (2Gi)");
  verb.add_option("--server-image", job.server_image, "of a policy server in each pod");
  verb.add_option("--server-command", job.server_command, "its words, where the image has none")
      .one_each();
  verb.add_option("--server-port", job.server_port, "where it listens (8000)").between(1, 65535);
  verb.add_option("--server-wait", job.server_wait_s, "seconds until it answers (600)")
      .between(1, 86400);
  verb.add_option("--gpus", job.gpus, "of each server (0)").between(0, 64);
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = k8s_verb(*arguments); });
}

}  // namespace probe::cli
