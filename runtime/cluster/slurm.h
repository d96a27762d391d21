// `vlaprobe slurm`: a run as an array job of Slurm. Writes the job, and if asked submits it, waits
// for it and merges its shards. What a task stored is never run again.
//
// OUT/suite.plan, results.sqlite, traces/   the merged run, as `vlaprobe run` leaves it
// OUT/shards/I-of-N/                        each task's run
// OUT/slurm/{job.sh, merge.sh, suite.plan, job, merge_job, log/{I, merge}.txt}
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/cluster/array_work.h"
#include "runtime/cluster/job_script.h"
#include "runtime/run/run.h"
#include "runtime/store/merge.h"

namespace probe::cluster {

struct ArrayOptions {
  JobScript script;  // program, tasks, whole_nodes, server_command, server_wait_s, sbatch
  bool submit = false;
  bool detach = false;  // submit, with a job that joins the shards, and do not wait
  double poll_s = 5;  // between two questions to the queue
  // Sentences as things happen: "job 17 has 3 tasks running and 1 waiting".
  std::function<void(const std::string&)> tell;
};
struct SlurmOptions : ArrayOptions {
  std::string time_from;  // folder of a run by which each task's time is measured; empty: none
  run::RunOptions run;  // policy, name, out, what to choose; `jobs` are each task's worlds
};

struct SlurmReport {
  std::string script;       // path of the job
  std::string job;          // Slurm's number of it; empty: nothing was submitted
  std::string merge_job;    // of the one that joins its shards, of `detach`
  std::int64_t total = 0;   // chosen episodes
  std::int64_t stored = 0;  // of them valid in the merged run
  store::MergeSummary merged;
  std::vector<std::string> notes;  // what each unfinished shard said last
};

// Fails (kUsage) on arguments that no task could run with, (kStore) when the folder is
// of another plan or policy, (kCluster) when Slurm refuses the job or does not answer. A job
// that was submitted into this folder before and has not ended is waited for, not submitted again,
// nor is a job that joins its shards disturbed.
Result<SlurmReport> run_on_slurm(const plan::Plan& plan, const SlurmOptions& options);

// The same of any work into the folder `out`; `worlds` are each task's --jobs.
Result<SlurmReport> work_on_slurm(const plan::Plan& plan, const ArrayWork& work,
                                  const std::string& out, int worlds, bool mixed_builds,
                                  const ArrayOptions& options);

}  // namespace probe::cluster
