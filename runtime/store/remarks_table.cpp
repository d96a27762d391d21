#include "runtime/store/remarks_table.h"

namespace probe::store {

Status RemarksTable::put(const EpisodeKey& key, const std::optional<std::string>& remark) {
  PROBE_ASSIGN(const bool has_table, is_there());
  if (!has_table && !remark) return {};
  if (!has_table) {
    PROBE_TRY(database_.execute(
        "create table remarks (task text not null, episode integer not null, seed integer not "
        "null, remark text not null, primary key (task, episode, seed)) without rowid"));
  }
  Statement write(database_,
                  remark ? "insert or replace into remarks values (?, ?, ?, ?)"
                         : "delete from remarks where task = ? and episode = ? and seed = ?",
                  Database::Access::kWrite);
  write.bind(key.task).bind(key.episode).bind(key.seed);
  if (remark) write.bind(*remark);
  write.next();
  return write.done();
}

Result<std::map<EpisodeKey, std::string>> RemarksTable::all() {
  std::map<EpisodeKey, std::string> remarks;
  PROBE_ASSIGN(const bool has_table, is_there());
  if (!has_table) return remarks;
  Statement select(database_, "select task, episode, seed, remark from remarks");
  while (select.next())
    remarks[{select.text(0), select.number(1), select.number(2)}] = select.text(3);
  PROBE_TRY(select.done());
  return remarks;
}

Result<bool> RemarksTable::is_there() {
  Statement table(database_, "select 1 from sqlite_master where name = 'remarks'");
  const bool found = table.next();
  PROBE_TRY(table.done());
  return found;
}

}  // namespace probe::store
