// The verbs that make worlds or read runs, and with them the simulator's libraries.
#pragma once

#include "runtime/cli/draw.h"
#include "runtime/cli/verbs.h"

namespace probe::cli {

void add_preview(Verb app, int& exit);
void add_sheet(Verb app, int& exit);
void add_run(Verb app, int& exit);
void add_sweep(Verb app, int& exit);
void add_search(Verb app, int& exit);
void add_ask(Verb app, int& exit);
void add_merge(Verb app, int& exit);
void add_slurm(Verb app, int& exit);
void add_slurm_ask(Verb app, int& exit);
void add_policy(Verb app, int& exit);
void add_serve(Verb app, int& exit);
void add_results(Verb app, int& exit);
void add_replay(Verb app, int& exit);
void add_judge(Verb app, int& exit);
void add_why(Verb app, int& exit);
void add_report(Verb app, int& exit);
void add_compare(Verb app, int& exit);
void add_gate(Verb app, int& exit);
void add_du(Verb app, int& exit);
void add_gc(Verb app, int& exit);
void add_mcp(Verb app, int& exit);
void add_k8s(Verb app, int& exit);
void add_demos(Verb app, int& exit);
void add_export(Verb app, int& exit);
void add_assets(Verb app, int& exit);
void add_libero(Verb app, int& exit);
void add_studio(Verb app, int& exit);
void add_doctor(Verb app, int& exit);
void add_demo(Verb app, int& exit);
void add_completion(Verb app, int& exit);
void add_manual(Verb app, int& exit);

int draw_phrases(const LoadedPlan& loaded, const DrawArguments& arguments);

}  // namespace probe::cli
