#include "runtime/cluster/kubernetes.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/base/json.h"
#include "runtime/wire/base64.h"

namespace probe::cluster {
namespace {

constexpr char kProgram[] = "/opt/vlaprobe/bin/vlaprobe";
// Of the API: an object has 1 MiB, in base64.
constexpr std::size_t kLargestPlan = 700'000;

Failure refusal(std::string message, const char* where) {
  return {Fault::kUsage, std::move(message), where};
}

// RFC 1123's label, as names of Jobs are.
bool is_label(std::string_view text, std::size_t most) {
  const auto is_fine = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
  return !text.empty() && text.size() <= most && is_fine(text.front()) && is_fine(text.back()) &&
         std::ranges::all_of(text, [&](char c) { return is_fine(c) || c == '-'; });
}

// A tree as YAML for people. Texts are quoted as JSON quotes them, which YAML reads.
void put_yaml(std::string& out, const Json& json, std::size_t depth) {
  const std::string indent(2 * depth, ' ');
  const auto put = [&](const Json& value) {
    if ((value.is_object() || value.is_array()) && !value.empty()) {
      out += "\n";
      put_yaml(out, value, depth + 1);
    } else {
      out += " " + value.dump() + "\n";
    }
  };
  for (const auto& [key, value] : json.items()) {
    out += indent + key + ":";
    put(value);
  }
  if (!json.is_array()) return;
  for (const Json& value : json) {
    if (value.is_object() && !value.empty()) {
      std::string inner;
      put_yaml(inner, value, depth + 1);
      inner.replace(2 * depth, 2, "- ");
      out += inner;
    } else {
      out += indent + "- " + value.dump() + "\n";
    }
  }
}

std::string yaml_text(const Json& json) {
  std::string out;
  put_yaml(out, json, 0);
  return out;
}

Json words(const std::vector<std::string>& list) {
  Json json = Json::array();
  for (const std::string& word : list) json.push_back(word);
  return json;
}

Status check(const KubernetesJob& job) {
  constexpr std::size_t kMostName = 40;  // with -merge and an index behind it a label's 63
  if (!is_label(job.name, kMostName))
    return refusal(fmt::format("`{}` is no name of a Job: a-z, 0-9 and -, at most {}", job.name,
                             kMostName),
                 "--job-name");
  if (job.image.empty()) return refusal("an image with vlaprobe is needed", "--image");
  if (!is_label(job.claim, 63))
    return refusal("names a PersistentVolumeClaim: a-z, 0-9 and -", "--claim");
  const bool is_path = !job.folder.empty() && job.folder[0] != '/' &&
                       job.folder.find("..") == job.folder.npos &&
                       job.folder.find("$(") == job.folder.npos;
  if (!is_path) return refusal("is a folder's name below the claim", "-o");
  if (job.server_image.empty() && !job.server_command.empty())
    return refusal("is of a server, whose image --server-image names", "--server-command");
  return {};
}

std::string folder_of(const KubernetesJob& job) { return "/runs/" + job.folder; }

Json volume_of_runs(const KubernetesJob& job) {
  Json volume = {{"name", "runs"}};
  volume["persistentVolumeClaim"]["claimName"] = job.claim;
  return volume;
}

Json mount(const char* name, const char* path, bool read_only) {
  Json json = {{"name", name}, {"mountPath", path}};
  if (read_only) json["readOnly"] = true;
  return json;
}

// Nobody but an ordinary user, and nothing of the node.
Json container_security() {
  Json json = {{"allowPrivilegeEscalation", false}};
  json["capabilities"]["drop"] = Json::array({"ALL"});
  return json;
}
Json pod_security() {
  return {{"runAsNonRoot", true}, {"runAsUser", 1000}, {"runAsGroup", 1000}, {"fsGroup", 1000}};
}

Json worlds_container(const KubernetesJob& job) {
  std::vector<std::string> call = {kProgram,     "run",          "/plan/suite.plan",
                                   "--shard",    fmt::format("@$(SHARD)/{}", job.tasks),
                                   "-o",         fmt::format("{}/shards/$(SHARD)-of-{}", folder_of(job), job.tasks),
                                   "--policy",   job.policy,
                                   "--name",     job.row_name,
                                   "--jobs",     std::to_string(job.worlds)};
  call.insert(call.end(), job.run_arguments.begin(), job.run_arguments.end());
  // What has $( in it would be taken for a variable.
  for (std::size_t i = 7; i < call.size(); ++i) {
    for (std::size_t at = 0; (at = call[i].find("$(", at)) != std::string::npos; at += 3)
      call[i].insert(at, "$");
  }
  Json shard = {{"name", "SHARD"}};
  shard["valueFrom"]["fieldRef"]["fieldPath"] =
      "metadata.annotations['batch.kubernetes.io/job-completion-index']";
  Json json = {{"name", "worlds"}, {"image", job.image}, {"command", words(call)}};
  json["env"].push_back(std::move(shard));
  json["env"].push_back({{"name", "VLAPROBE_CACHE"}, {"value", "/tmp/vlaprobe"}});
  json["resources"]["requests"] = {{"cpu", std::to_string(job.worlds)}, {"memory", job.memory}};
  json["resources"]["limits"]["memory"] = job.memory;
  json["volumeMounts"].push_back(mount("plan", "/plan", true));
  json["volumeMounts"].push_back(mount("runs", "/runs", false));
  json["volumeMounts"].push_back(mount("tmp", "/tmp", false));
  json["securityContext"] = container_security();
  return json;
}

// A container that is started before the worlds and ended behind them (a native sidecar, from
// Kubernetes 1.29 on).
Json server_container(const KubernetesJob& job) {
  constexpr int kEvery = 5;  // s
  Json json = {{"name", "policy"}, {"image", job.server_image}, {"restartPolicy", "Always"}};
  if (!job.server_command.empty()) json["command"] = words(job.server_command);
  json["ports"].push_back({{"containerPort", job.server_port}});
  json["startupProbe"]["tcpSocket"]["port"] = job.server_port;
  json["startupProbe"]["periodSeconds"] = kEvery;
  json["startupProbe"]["failureThreshold"] = std::max(1, job.server_wait_s / kEvery);
  if (job.gpus > 0) json["resources"]["limits"]["nvidia.com/gpu"] = job.gpus;
  return json;
}

Json pod(const KubernetesJob& job, Json container) {
  Json spec = {{"restartPolicy", "Never"}, {"securityContext", pod_security()}};
  spec["containers"].push_back(std::move(container));
  spec["volumes"].push_back(volume_of_runs(job));
  return spec;
}

Json job_object(const std::string& name) {
  Json json = {{"apiVersion", "batch/v1"}, {"kind", "Job"}};
  json["metadata"]["name"] = name;
  json["metadata"]["labels"] = {{"app.kubernetes.io/name", "vlaprobe"}};
  return json;
}

}  // namespace

Result<std::string> job_manifest(const KubernetesJob& job, const plan::Plan& plan) {
  PROBE_TRY(check(job));
  const auto bytes = plan.bytes();
  if (bytes.size() > kLargestPlan) {
    return refusal(fmt::format("has {} bytes, and a ConfigMap holds {}; choose fewer tasks, as a "
                             "suite of their own",
                             bytes.size(), kLargestPlan),
                 "F");
  }
  Json map = {{"apiVersion", "v1"}, {"kind", "ConfigMap"}};
  map["metadata"]["name"] = job.name + "-plan";
  const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
  map["binaryData"]["suite.plan"] = wire::to_base64({first, bytes.size()});

  Json json = job_object(job.name);
  Json& spec = json["spec"];
  spec["completionMode"] = "Indexed";
  spec["completions"] = job.tasks;
  spec["parallelism"] = job.tasks;
  spec["backoffLimitPerIndex"] = 3;
  // A node that is drained or preempted is no failure; another pod continues the shard. What the
  // user has to mend (exit 1) is not tried again.
  Json preempted = {{"action", "Ignore"}}, refused = {{"action", "FailIndex"}};
  preempted["onPodConditions"].push_back({{"type", "DisruptionTarget"}, {"status", "True"}});
  refused["onExitCodes"] = {
      {"containerName", "worlds"}, {"operator", "In"}, {"values", Json::array({1})}};
  spec["podFailurePolicy"]["rules"].push_back(std::move(preempted));
  spec["podFailurePolicy"]["rules"].push_back(std::move(refused));
  Json template_spec = pod(job, worlds_container(job));
  Json plan_volume = {{"name", "plan"}};
  plan_volume["configMap"]["name"] = job.name + "-plan";
  template_spec["volumes"].push_back(std::move(plan_volume));
  template_spec["volumes"].push_back({{"name", "tmp"}, {"emptyDir", Json::object()}});
  if (!job.server_image.empty())
    template_spec["initContainers"].push_back(server_container(job));
  spec["template"]["spec"] = std::move(template_spec);
  return fmt::format("# vlaprobe: {} shards; a pod that comes anew continues its shard.\n"
                     "#   kubectl apply -f job.yaml && kubectl wait --for=condition=complete "
                     "--timeout=-1s job/{}\n#   kubectl apply -f merge.yaml\n",
                     job.tasks, job.name) +
         yaml_text(map) + "---\n" + yaml_text(json);
}

Result<std::string> merge_manifest(const KubernetesJob& job) {
  PROBE_TRY(check(job));
  std::vector<std::string> call = {kProgram, "merge"};
  for (int shard = 0; shard < job.tasks; ++shard)
    call.push_back(fmt::format("{}/shards/{}-of-{}", folder_of(job), shard, job.tasks));
  call.insert(call.end(), {"-o", folder_of(job)});
  Json container = {{"name", "merge"}, {"image", job.image}, {"command", words(call)}};
  container["env"].push_back({{"name", "VLAPROBE_CACHE"}, {"value", ""}});
  container["resources"]["requests"] = {{"cpu", "2"}, {"memory", job.memory}};
  container["volumeMounts"].push_back(mount("runs", "/runs", false));
  container["securityContext"] = container_security();
  Json json = job_object(job.name + "-merge");
  json["spec"]["backoffLimit"] = 6;
  json["spec"]["template"]["spec"] = pod(job, std::move(container));
  return yaml_text(json);
}

}  // namespace probe::cluster
