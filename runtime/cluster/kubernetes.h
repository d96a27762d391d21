// `vlaprobe k8s`: a run as an Indexed Job of Kubernetes, one shard an index, and a Job that merges
// them. Texts in, texts out; asks no cluster.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"

namespace probe::cluster {

struct KubernetesJob {
  std::string name = "vlaprobe";  // of the Job
  std::string image;              // that has vlaprobe at /opt/vlaprobe, as `.ci/package oci` makes it
  std::string claim;              // a PersistentVolumeClaim that all nodes can write, at /runs
  std::string folder;             // below /runs: shards/INDEX, and the merged run
  int tasks = 1, worlds = 1;      // shards; of each, one CPU each
  std::string policy, row_name;
  std::vector<std::string> run_arguments;  // further words for `vlaprobe run`
  std::string memory = "2Gi";              // of each shard
  // A policy server beside each shard's worlds, in the same pod: started first, waited for, ended
  // with it. No image: the policy's address leads elsewhere.
  std::string server_image;
  std::vector<std::string> server_command;
  int server_port = 8000, server_wait_s = 600, gpus = 0;
};

// Documents of YAML: the plan (a ConfigMap) and the Job. What preempts or drains a node does not
// count as a failure; a pod that comes anew continues its shard. Fails (kUsage) on names that the
// API refuses, on a plan that no ConfigMap holds, and on a server's command without an image.
Result<std::string> job_manifest(const KubernetesJob& job, const plan::Plan& plan);
// The Job that joins the shards, once the other is complete.
Result<std::string> merge_manifest(const KubernetesJob& job);

}  // namespace probe::cluster
