#include "runtime/cli/full/add_all.h"

#include "runtime/cli/full/verbs.h"

namespace probe::cli {

void add_all_verbs(Verb program, int& exit) {
  add_text_verbs(program, exit, draw_phrases);
  add_preview(program, exit);
  add_sheet(program, exit);
  add_run(program, exit);
  add_sweep(program, exit);
  add_search(program, exit);
  add_ask(program, exit);
  add_merge(program, exit);
  add_slurm(program, exit);
  add_slurm_ask(program, exit);
  add_k8s(program, exit);
  add_policy(program, exit);
  add_serve(program, exit);
  add_results(program, exit);
  add_replay(program, exit);
  add_judge(program, exit);
  add_why(program, exit);
  add_report(program, exit);
  add_compare(program, exit);
  add_gate(program, exit);
  add_du(program, exit);
  add_gc(program, exit);
  add_demos(program, exit);
  add_export(program, exit);
  add_assets(program, exit);
  add_libero(program, exit);
  add_studio(program, exit);
  add_mcp(program, exit);
  add_doctor(program, exit);
  add_demo(program, exit);
  add_completion(program, exit);
  add_manual(program, exit);
}

}  // namespace probe::cli
