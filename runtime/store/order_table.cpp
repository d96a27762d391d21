#include "runtime/store/order_table.h"

namespace probe::store {
namespace {

// As many as a folder has rows at most.
constexpr std::size_t kMostPlaces = 4'000'000;

}  // namespace

Result<std::vector<OrderedEpisode>> OrderTable::read() {
  std::vector<OrderedEpisode> order;
  PROBE_ASSIGN(const bool has_table, is_there());
  if (!has_table) return order;
  Statement select(database_, "select task, episode, seed, other from planned order by place");
  while (select.next()) {
    if (order.size() >= kMostPlaces)
      return Failure{Fault::kStore, "results.sqlite has a longer order than any run",
                     database_.path()};
    OrderedEpisode& one = order.emplace_back();
    one.key = {select.text(0), select.number(1), select.number(2)};
    if (select.kind(3) != Statement::Kind::kNull) one.other = select.number(3) != 0;
  }
  PROBE_TRY(select.done());
  return order;
}

Status OrderTable::write(std::span<const OrderedEpisode> order) {
  PROBE_TRY(database_.execute(
      "create table if not exists planned (place integer primary key, task text not null, episode "
      "integer not null, seed integer not null, other integer)"));
  Statement insert(database_, "insert into planned values (?, ?, ?, ?, ?)",
                   Database::Access::kWrite);
  for (std::size_t place = 0; place < order.size(); ++place) {
    const OrderedEpisode& one = order[place];
    insert.restart();
    insert.bind(static_cast<std::int64_t>(place))
        .bind(one.key.task)
        .bind(one.key.episode)
        .bind(one.key.seed);
    if (one.other) {
      insert.bind(*one.other ? 1 : 0);
    } else {
      insert.bind_null();
    }
    insert.next();
    PROBE_TRY(insert.done());
  }
  return {};
}

Status OrderTable::clear() {
  PROBE_ASSIGN(const bool has_table, is_there());
  return has_table ? database_.execute("drop table planned") : Status();
}

Result<bool> OrderTable::is_there() {
  Statement table(database_, "select 1 from sqlite_master where name = 'planned'");
  const bool found = table.next();
  PROBE_TRY(table.done());
  return found;
}

}  // namespace probe::store
