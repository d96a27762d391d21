#include "runtime/store/remarks_table.h"

#include <utility>

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

Status RemarksTable::add_to(std::span<ResultRow> rows) {
  if (rows.empty()) return {};
  PROBE_ASSIGN(const bool has_table, is_there());
  if (!has_table) return {};
  Statement select(
      database_,
      "select episode, seed, remark from remarks where task = ? and (episode, seed) >= (?, ?) "
      "and (episode, seed) <= (?, ?) order by episode, seed");
  const ResultRow &first = rows.front(), &last = rows.back();
  select.bind(first.task).bind(first.episode).bind(first.seed).bind(last.episode).bind(last.seed);
  // Both ascend.
  std::size_t at = 0;
  while (select.next()) {
    const std::pair key(select.number(0), select.number(1));
    while (at < rows.size() && std::pair(rows[at].episode, rows[at].seed) < key) ++at;
    if (at == rows.size()) break;
    if (std::pair(rows[at].episode, rows[at].seed) == key) rows[at].remark = select.text(2);
  }
  return select.done();
}

Result<bool> RemarksTable::is_there() {
  Statement table(database_, "select 1 from sqlite_master where name = 'remarks'");
  const bool found = table.next();
  PROBE_TRY(table.done());
  return found;
}

}  // namespace probe::store
