// The text of a Slurm job: an array with one task a shard, each with its own server if there is a
// command for one; or, where the server wants another kind of node than the worlds, a heterogeneous
// job (Slurm has no arrays of those) with the server in one part and all shards in the other. Texts
// in, text out; submits nothing.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace probe::cluster {

struct JobScript {
  std::string verb = "run";                // of vlaprobe, in each task
  std::string actor_flag = "--policy";     // with which that verb is told who acts
  std::string program;                     // absolute path of vlaprobe on the nodes
  std::string plan;                        // absolute path of the plan file
  std::string out;                         // absolute path of the folder of all shards
  int tasks = 1;                           // of the array: shards
  int worlds = 1;                          // of each task, one CPU each
  bool whole_nodes = false;                // a node is not shared with other jobs
  std::string policy;                      // `{port}` stands for the port of the task's own server
  std::string name;                        // what the rows call the policy
  std::string server_command;              // a line of shell, `{port}` as above; empty: worlds only
  int server_wait_s = 600;                 // until the server answers
  // Options of sbatch for one server that all tasks ask, on a node of its own: a heterogeneous job.
  // Then `{host}` in the policy stands for that node.
  bool server_apart = false;
  std::vector<std::string> server_sbatch;
  std::vector<std::string> run_arguments;  // further words for `vlaprobe run`
  std::vector<std::string> sbatch;         // further options of sbatch, "--partition=gpu"
  std::int64_t time_s = 0;                 // that each task asks for; 0: the cluster's default
};

// Fails (kUsage) on what cannot be written down: line breaks in an sbatch option or the
// server's command, `{port}` in the policy without a server's command, `{host}` without a server
// apart or the other way round, two times.
Result<std::string> to_text(const JobScript& script);

// The job that joins the shards when the other has ended. Of the options of sbatch it takes those
// that say who asks and where: account, clusters, constraint, partition, qos, reservation, wckey.
Result<std::string> merge_text(const JobScript& script, bool mixed_builds);

// The folder of one shard's run below `out`: "shards/2-of-4".
std::string shard_folder(int shard, int shards);

}  // namespace probe::cluster
