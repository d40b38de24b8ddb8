// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/map_store.hpp"

#include "geometry/index.hpp"
#include "store/database.hpp"
#include "store/file_lock.hpp"
#include "store/first_version.hpp"
#include "store/memory_rows.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace trussmap {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kApplication = 0x7472736d;  // "trsm"
constexpr std::int64_t kVersion = 2;
constexpr std::int64_t kFirstVersion = 1;
constexpr int kCallKinds = 5;

constexpr const char* kTaken = "is being written by another program, expected one at a time";

InputError said(const fs::path& file, const DatabaseError& error) {
  if (error.busy()) return {file.string(), 0, kTaken};
  if (error.no_database()) return {file.string(), 0, "is no map store"};
  return {file.string(), 0, std::string("cannot be read or written: ") + error.what()};
}

/// Calls something; what the database or damaged rows throw becomes an InputError.
template <typename Call>
auto naming(const fs::path& file, const Call& call) {
  try {
    return call();
  } catch (const DatabaseError& error) {
    throw said(file, error);
  }
}

/// With a folder in front: SQLite gives a meaning of its own to some names, and takes a byte for
/// nothing.
fs::path place_of(const fs::path& file) {
  if (file.empty()) throw InputError("map store", 0, "has no name, expected a file");
  std::error_code failed;
  fs::path place = fs::absolute(file, failed);
  if (failed) throw InputError(file.string(), 0, "cannot be found: " + failed.message());
  if (fs::is_directory(place, failed)) {
    throw InputError(file.string(), 0, "is a folder, expected a map store");
  }
  constexpr std::uintmax_t kHeader = 100;  // bytes of the smallest database
  const std::uintmax_t size = fs::file_size(place, failed);
  if (!failed && size > 0 && size < kHeader) throw InputError(file.string(), 0, "is no map store");
  return place;
}

/// Links followed, so that two names of one store are one lock.
fs::path lock_of(const fs::path& place) {
  std::error_code ignored;
  fs::path followed = fs::weakly_canonical(place, ignored);
  if (ignored) followed = place;
  followed += "-lock";
  return followed;
}

class Facts {
 public:
  explicit Facts(const Database& database)
      : get_(database, "SELECT value FROM facts WHERE name = ?"),
        put_(database, "REPLACE INTO facts VALUES (?, ?)") {}

  std::string text(const std::string& name) {
    get_.bind(0, name);
    std::string value = get_.step() ? get_.text(0) : std::string();
    get_.reset();
    return value;
  }

  double real(const std::string& name) {
    get_.bind(0, name);
    const double value = get_.step() ? get_.real(0) : 0.0;
    get_.reset();
    return value;
  }

  template <typename Value>
  void put(const std::string& name, const Value& value) {
    put_.bind(0, name).bind(1, value).run();
  }

 private:
  Statement get_;
  Statement put_;
};

/// The facts that are options, as the columns of a row.
class OptionFacts final : public RowReader, public RowWriter {
 public:
  explicit OptionFacts(Facts& facts) : facts_(facts) {
    std::istringstream columns(kOptionsTable.columns);
    for (std::string name; std::getline(columns >> std::ws, name, ',');) names_.push_back(name);
  }

  [[nodiscard]] double real(int column) const override { return facts_.real(name(column)); }
  [[nodiscard]] std::int64_t integer(int column) const override {
    return static_cast<std::int64_t>(std::clamp(real(column), -1e9, 1e9));
  }
  [[nodiscard]] std::string text(int column) const override { return facts_.text(name(column)); }
  [[nodiscard]] bool is_null(int /*column*/) const override { return false; }

  using RowWriter::bind;
  OptionFacts& bind(int column, double value) override { return put(column, value); }
  OptionFacts& bind(int column, std::int64_t value) override { return put(column, value); }
  OptionFacts& bind(int column, const std::string& text) override { return put(column, text); }

 private:
  [[nodiscard]] const std::string& name(int column) const { return names_[idx(column)]; }
  template <typename Value>
  OptionFacts& put(int column, const Value& value) {
    facts_.put(name(column), value);
    return *this;
  }

  Facts& facts_;
  std::vector<std::string> names_;
};

MapBuilderOptions options_among(Facts& facts) {
  return options_in(OptionFacts(facts));
}

void put_options_among(Facts& facts, const MapBuilderOptions& options) {
  OptionFacts row(facts);
  put_options(row, options);
}

void make(const Database& database, const MapBuilderOptions& options) {
  database.run(joined("PRAGMA application_id = ", kApplication));
  database.run(joined("PRAGMA user_version = ", kVersion));
  database.run(R"sql(
    CREATE TABLE facts(name TEXT PRIMARY KEY, value) WITHOUT ROWID;
    CREATE TABLE sessions(number INTEGER PRIMARY KEY, key TEXT NOT NULL UNIQUE,
                          name TEXT NOT NULL, first_leg INTEGER NOT NULL, legs INTEGER NOT NULL);
    CREATE TABLE legs(number INTEGER PRIMARY KEY, session INTEGER, kind INTEGER NOT NULL,
                      source INTEGER, target INTEGER, own_axes INTEGER, dx REAL, dy REAL,
                      turn REAL, c_xx REAL, c_xy REAL, c_yy REAL, c_xt REAL, c_yt REAL, c_tt REAL,
                      ox REAL, oy REAL, o_xx REAL, o_xy REAL, o_yy REAL, outcome INTEGER);
  )sql");
  create_memory_tables(database);
  Facts facts(database);
  put_options_among(facts, options);
}

/// Blanks and ends of lines as one blank each.
std::string on_one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\n';
    if (!blank || line.empty() || line.back() != ' ') line += blank ? ' ' : c;
  }
  return line;
}

/// How the store's tables were made, and all triggers. Statements in either could do anything.
std::vector<std::string> tables_of(const Database& database) {
  Statement rows(
      database,
      "SELECT type || ' ' || name || ' ' || ifnull(sql, '') FROM sqlite_schema "
      "WHERE type = 'trigger' OR tbl_name COLLATE NOCASE IN ('facts', 'sessions', "
      "'legs', 'landmarks', 'routes', 'reckoned', 'corners', 'chain', 'misfits', 'left_out', "
      "'state', 'map') "
      "ORDER BY 1");
  std::vector<std::string> tables;
  while (rows.step()) tables.push_back(on_one_line(rows.text(0)));
  return tables;
}

/// A new store's.
const std::vector<std::string>& made_tables() {
  static const std::vector<std::string> kTables = [] {
    const Database memory(":memory:", Database::Access::write);
    make(memory, {});
    return tables_of(memory);
  }();
  return kTables;
}

const std::vector<std::string>& first_tables() {
  static const std::vector<std::string> kTables = [] {
    const Database memory(":memory:", Database::Access::write);
    create_first_version(memory);
    return tables_of(memory);
  }();
  return kTables;
}

bool is_of_first_version(const Database& database) {
  return database.number("PRAGMA user_version") == kFirstVersion;
}

void upgrade(const Database& database) {
  upgrade_first_version(database, [&] { make(database, {}); });
}

/// False: there is nothing yet. Throws InputError where there is something else.
bool is_made(const fs::path& file, const Database& database) {
  const std::int64_t application = database.number("PRAGMA application_id");
  const std::int64_t version = database.number("PRAGMA user_version");
  if (application == 0 && database.number("SELECT count(*) FROM sqlite_schema") == 0) return false;
  if (application != kApplication) throw InputError(file.string(), 0, "is no map store");
  if (version != kVersion && version != kFirstVersion) {
    throw InputError(file.string(), 0,
                     joined("is a map store of version ", version, ", expected ", kVersion));
  }
  if (tables_of(database) != (version == kFirstVersion ? first_tables() : made_tables())) {
    throw InputError(file.string(), 0, "is damaged: its tables are not those of a map store");
  }
  return true;
}

std::int64_t legs_in(const Database& database) {
  constexpr std::int64_t kMost = 1'000'000'000'000'000;
  const std::int64_t legs = database.number("SELECT max(number) + 1 FROM legs");
  if (legs < 0 || legs > kMost) throw std::invalid_argument("a leg that is misnumbered");
  return legs;
}

/// Legs name sessions by their place. Throws std::invalid_argument where rows are missing.
std::vector<StoredSession> sessions_in(const Database& database) {
  Statement rows(database,
                 "SELECT number, key, name, first_leg, legs FROM sessions ORDER BY number");
  std::vector<StoredSession> sessions;
  while (rows.step()) {
    if (rows.integer(0) != std::ssize(sessions) + 1) {
      throw std::invalid_argument("a session that is misnumbered");
    }
    sessions.push_back({rows.text(1), rows.text(2), rows.integer(3), rows.integer(4)});
  }
  return sessions;
}

/// What the rows of a damaged store are called.
template <typename Call>
auto undamaged(const fs::path& file, const Call& call) {
  try {
    return call();
  } catch (const std::invalid_argument& error) {
    throw InputError(file.string(), 0, std::string("is damaged: it has ") + error.what());
  }
}

/// For as long as it is held nobody else writes.
std::unique_ptr<FileLock> locked(const fs::path& file) {
  try {
    return std::make_unique<FileLock>(lock_of(place_of(file)));
  } catch (const std::system_error& error) {
    const bool taken = error.code() == std::errc::operation_would_block;
    throw InputError(file.string(), 0,
                     taken ? kTaken : "cannot be locked: " + error.code().message());
  }
}

}  // namespace

bool is_map_store(const fs::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".db" || ending == ".sqlite" || ending == ".sqlite3";
}

class __attribute__((visibility("hidden"))) MapStore::Impl {
 public:
  /// `first`: what a new store begins with; null: with nothing, or go on.
  Impl(const fs::path& file, const std::optional<MapBuilderOptions>& options,
       const MapBuilderOptions& if_new, const MapBuilder* first)
      : file_(file), lock_(locked(file)), database_(open(first != nullptr)) {
    database_.run("BEGIN IMMEDIATE");
    if (!is_made(file_, database_)) {
      make(database_, options.value_or(if_new));
      if (first != nullptr) {
        MemoryRows(database_).save(BuilderAccess::settled_memory(*first), first->options());
      }
    } else if (is_of_first_version(database_)) {
      upgrade(database_);
    }
    database_.run("COMMIT");
    rows_.emplace(database_);
    facts_.emplace(database_);
    put_leg_.emplace(
        database_,
        "INSERT INTO legs VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    version_ = database_.number("PRAGMA data_version");
    load();
    if (options) take(*options);
  }

  /// Makes calls of the builder; they are kept, or the builder is as it was.
  void keep(const std::function<void()>& call, const StoredSession* session = nullptr) {
    naming(file_, [&] {
      const Busy busy(busy_);
      begin();
      journal_.clear();
      attempt(call, session);
      commit(session);
    });
  }

  [[nodiscard]] MapBuilder& builder() {
    if (!builder_) {
      throw InputError(file_.string(), 0,
                       "could not be read again after a call that failed, expected to be opened "
                       "anew");
    }
    return *builder_;
  }

  [[nodiscard]] std::int64_t legs() const { return legs_; }

  [[nodiscard]] std::vector<StoredSession> sessions() const {
    return naming(file_, [&] { return undamaged(file_, [&] { return sessions_in(database_); }); });
  }

  [[nodiscard]] bool has_session(const std::string& key) const {
    return naming(file_, [&] {
      Statement statement(database_, "SELECT 1 FROM sessions WHERE key = ?");
      statement.bind(0, key);
      return statement.step();
    });
  }

  void for_each_leg(const std::function<void(const StoredLeg&)>& visit) {
    naming(file_, [&] {
      const Busy busy(busy_);
      Statement rows(database_,
                     "SELECT kind, source, target, own_axes, dx, dy, turn, c_xx, c_xy, c_yy, c_xt, "
                     "c_yt, c_tt, ox, oy, o_xx, o_xy, o_yy, session, outcome, number FROM legs "
                     "ORDER BY number");
      const LandmarkGraph& graph = BuilderAccess::memory(builder()).graph;
      const std::int64_t count = std::ssize(sessions());
      const auto name = [&](int column) {
        const std::int64_t landmark = rows.is_null(column) ? -1 : rows.integer(column);
        if (landmark >= graph.landmarks()) {
          throw InputError(file_.string(), 0, "is damaged: it has a leg to no landmark");
        }
        return landmark < 0 ? std::string() : graph.landmark(static_cast<int>(landmark)).name;
      };
      const auto misnumbered = [&] {
        return InputError(file_.string(), 0, "is damaged: it has a leg that is misnumbered");
      };
      std::int64_t number = 0;
      while (rows.step()) {
        if (rows.integer(20) != number++) throw misnumbered();
        StoredLeg one;
        const std::int64_t kind = rows.integer(0);
        if (kind < 0 || kind >= kCallKinds) {
          throw InputError(file_.string(), 0, "is damaged: it has a leg of no kind");
        }
        one.kind = static_cast<StoredLeg::Kind>(kind);
        one.from = name(1);
        one.to = name(2);
        one.own_axes = rows.integer(3) != 0;
        one.leg.displacement = {rows.real(4), rows.real(5)};
        one.leg.covariance << rows.real(7), rows.real(8), rows.real(8), rows.real(9);
        one.motion.displacement = {rows.real(4), rows.real(5), rows.real(6)};
        one.motion.covariance << one.leg.covariance, Vector2(rows.real(10), rows.real(11)),
            rows.real(10), rows.real(11), rows.real(12);
        one.seen.offset_robot = {rows.real(13), rows.real(14)};
        one.seen.covariance_robot << rows.real(15), rows.real(16), rows.real(16), rows.real(17);
        const std::int64_t session = rows.is_null(18) ? -1 : rows.integer(18);
        if (session >= count) {
          throw InputError(file_.string(), 0, "is damaged: it has a leg of no session");
        }
        one.session = static_cast<int>(std::max<std::int64_t>(session, -1));
        if (!rows.is_null(19)) one.outcome = outcome_of(rows.integer(19));
        visit(one);
      }
      if (number != legs_) throw misnumbered();
    });
  }

  [[nodiscard]] std::string note(const std::string& name) {
    return naming(file_, [&] { return facts_->text("note:" + name); });
  }

  void set_note(const std::string& name, const std::string& text) {
    keep([&] { facts_->put("note:" + name, text); });
  }

 private:
  /// No call of the store within another one: it would keep half of that.
  class Busy {
   public:
    explicit Busy(bool& busy) : busy_(busy) {
      if (busy) throw std::logic_error("a map store is used within a call of its own");
      busy = true;
    }
    ~Busy() { busy_ = false; }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

   private:
    bool& busy_;
  };

  [[nodiscard]] Arrival::Kind outcome_of(std::int64_t number) const {
    if (number < 0 || number > static_cast<std::int64_t>(Arrival::Kind::found_again)) {
      throw InputError(file_.string(), 0, "is damaged: it has a leg of no outcome");
    }
    return static_cast<Arrival::Kind>(number);
  }

  Database open(bool must_be_new) {
    return naming(file_, [&] {
      const fs::path place = place_of(file_);
      std::error_code ignored;
      if (must_be_new && fs::exists(place, ignored)) {
        throw InputError(file_.string(), 0, "is there already, expected a new file");
      }
      Database database(place, Database::Access::write);
      is_made(file_, database);  // before anything is changed
      database.run("PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON");
      Statement wal(database, "PRAGMA journal_mode = WAL");
      if (!wal.step() || wal.text(0) != "wal") {
        throw InputError(file_.string(), 0,
                         "lies where no map store can: the file system has no shared memory");
      }
      database.run("PRAGMA synchronous = FULL");
      return database;
    });
  }

  void load() {
    undamaged(file_, [&] {
      const MapBuilderOptions options = options_among(*facts_);
      builder_.emplace(BuilderAccess::restored(rows_->load(options), options));
      legs_ = legs_in(database_);
      static_cast<void>(sessions_in(database_));
    });
    BuilderAccess::keep_journal(*builder_, &journal_);
  }

  /// A map without landmarks may still change its method.
  void take(const MapBuilderOptions& options) {
    const bool empty = builder().landmarks() == 0;
    if (!empty) builder().set_options(options);
    keep([&] { put_options_among(*facts_, options); });
    if (empty) load();
  }

  /// A program without our lock (SQLite's own, say) may have written since the last call: that map
  /// this builder does not know.
  void begin() {
    static_cast<void>(builder());
    database_.run("BEGIN IMMEDIATE");
    if (database_.number("PRAGMA data_version") == version_) return;
    database_.run("ROLLBACK");
    throw InputError(file_.string(), 0,
                     "was written by another program meanwhile, expected to be opened anew");
  }

  /// A single call that throws leaves the builder as it was; a session must be undone.
  void attempt(const std::function<void()>& call, const StoredSession* session) {
    try {
      call();
      check_same_builder();
    } catch (...) {
      if (session != nullptr || !journal_.empty()) {
        go_back();
      } else {
        database_.run("ROLLBACK");
      }
      throw;
    }
  }

  /// A session may have put another builder in the place of this one.
  void check_same_builder() {
    if (BuilderAccess::has_journal(builder(), &journal_)) return;
    throw std::logic_error("a session drives the store's builder on, and keeps it");
  }

  void commit(const StoredSession* session) {
    try {
      if (session != nullptr) put_session(*session);
      for (std::size_t k = 0; k < journal_.size(); ++k) put_leg(journal_[k], k, session != nullptr);
      rows_->save(BuilderAccess::settle_memory(*builder_), builder_->options());
      database_.run("COMMIT");
    } catch (...) {
      go_back();
      throw;
    }
    legs_ += static_cast<std::int64_t>(journal_.size());
  }

  void put_session(const StoredSession& session) {
    Statement put(database_,
                  "INSERT INTO sessions(key, name, first_leg, legs) VALUES (?, ?, ?, ?)");
    put.bind(0, session.key).bind(1, session.name).bind(2, legs_);
    put.bind(3, static_cast<std::int64_t>(journal_.size())).run();
    put_options_among(*facts_, builder_->options());  // which may have been set on the way
    session_ = database_.number("SELECT max(number) FROM sessions");
  }

  void put_leg(const BuilderCall& call, std::size_t place, bool in_session) {
    Statement& put = *put_leg_;
    put.bind(0, legs_ + static_cast<std::int64_t>(place)).bind(2, static_cast<int>(call.kind));
    if (in_session) put.bind(1, session_ - 1);  // places in sessions() count from 0
    if (call.from >= 0) put.bind(3, call.from);
    if (call.to >= 0) put.bind(4, call.to);
    put.bind(5, call.reckoned ? 1 : 0);
    if (call.reckoned || call.kind == BuilderCall::Kind::compass) {
      const Pose& moved = call.motion.displacement;
      const Matrix3& C = call.motion.covariance;
      put.bind(6, moved.position()).bind(8, moved.heading);
      put.bind(9, Matrix2(C.topLeftCorner<2, 2>())).bind(12, C(0, 2)).bind(13, C(1, 2));
      put.bind(14, C(2, 2));
    } else if (call.kind <= BuilderCall::Kind::observe) {
      put.bind(6, call.leg.displacement).bind(9, call.leg.covariance);
    }
    if (call.reckoned || call.kind == BuilderCall::Kind::start) {
      put.bind(15, call.seen.offset_robot).bind(17, call.seen.covariance_robot);
    }
    if (call.outcome) put.bind(20, static_cast<int>(*call.outcome));
    put.run();
  }

  /// To what the file holds.
  void go_back() noexcept {
    try {
      builder_.reset();
      if (database_.in_transaction()) database_.run("ROLLBACK");
      database_.run("BEGIN");
      load();
      version_ = database_.number("PRAGMA data_version");  // a failed write may change it, too
      database_.run("COMMIT");
    } catch (...) {
      builder_.reset();
    }
  }

  fs::path file_;
  std::unique_ptr<FileLock> lock_;
  Database database_;
  std::optional<MemoryRows> rows_;
  std::optional<Facts> facts_;
  std::optional<Statement> put_leg_;
  std::optional<MapBuilder> builder_;
  std::vector<BuilderCall> journal_;  // of the present call
  bool busy_ = false;                 // a call is under way
  std::int64_t legs_ = 0;
  std::int64_t session_ = 0;
  std::int64_t version_ = 0;  // changes when another program has written
};

MapStore::MapStore(const fs::path& file, const std::optional<MapBuilderOptions>& options,
                   const MapBuilderOptions& if_new)
    : impl_(naming(file, [&] {
        // Refuses options out of range before there is a file.
        const MapBuilder in_range(options.value_or(if_new));
        return std::make_unique<Impl>(file, options, if_new, nullptr);
      })) {}
MapStore::MapStore(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MapStore::~MapStore() = default;
MapStore::MapStore(MapStore&&) noexcept = default;
MapStore& MapStore::operator=(MapStore&&) noexcept = default;

MapStore MapStore::create(const fs::path& file, const LandmarkGraph& map,
                          const MapBuilderOptions& options) {
  const MapBuilder first(map, options);
  return MapStore(
      naming(file, [&] { return std::make_unique<Impl>(file, options, options, &first); }));
}

MapStore MapStore::create(const fs::path& file, const MapBuilder& builder) {
  return MapStore(naming(file, [&] {
    return std::make_unique<Impl>(file, builder.options(), builder.options(), &builder);
  }));
}

void MapStore::start(const std::string& landmark, const Vector2& position) {
  impl_->keep([&] { impl_->builder().start(landmark, position); });
}

void MapStore::start(const std::string& landmark, const LandmarkOffset& seen,
                     const Vector2& position) {
  impl_->keep([&] { impl_->builder().start(landmark, seen, position); });
}

Arrival MapStore::arrive(const std::string& landmark, const Traversal& leg) {
  Arrival arrival;
  impl_->keep([&] { arrival = impl_->builder().arrive(landmark, leg); });
  return arrival;
}

Arrival MapStore::observe(const std::string& landmark, const Traversal& from_here) {
  Arrival arrival;
  impl_->keep([&] { arrival = impl_->builder().observe(landmark, from_here); });
  return arrival;
}

void MapStore::compass(double reading, double sd) {
  impl_->keep([&] { impl_->builder().compass(reading, sd); });
}

Arrival MapStore::arrive(const std::string& landmark, const Motion& motion,
                         const LandmarkOffset& seen) {
  Arrival arrival;
  impl_->keep([&] { arrival = impl_->builder().arrive(landmark, motion, seen); });
  return arrival;
}

Arrival MapStore::observe(const std::string& landmark, const LandmarkOffset& seen) {
  Arrival arrival;
  impl_->keep([&] { arrival = impl_->builder().observe(landmark, seen); });
  return arrival;
}

double MapStore::relax() {
  double largest_move = 0.0;
  impl_->keep([&] { largest_move = impl_->builder().relax(); });
  return largest_move;
}

void MapStore::append(const std::string& key, const std::string& name,
                      const std::function<void(MapBuilder&)>& drive) {
  if (key.empty() || has_session(key)) {
    throw std::invalid_argument("a session of a store needs a key of its own");
  }
  const StoredSession session{key, name, 0, 0};
  impl_->keep([&] { drive(impl_->builder()); }, &session);
}

const MapBuilder& MapStore::builder() const {
  return impl_->builder();
}

std::vector<StoredSession> MapStore::sessions() const {
  return impl_->sessions();
}

bool MapStore::has_session(const std::string& key) const {
  return impl_->has_session(key);
}

std::int64_t MapStore::legs() const {
  return impl_->legs();
}

void MapStore::for_each_leg(const std::function<void(const StoredLeg&)>& visit) const {
  impl_->for_each_leg(visit);
}

std::string MapStore::note(const std::string& name) const {
  return impl_->note(name);
}

void MapStore::set_note(const std::string& name, const std::string& text) {
  impl_->set_note(name, text);
}

namespace {

/// Calls `read` with a store's database and options, within one transaction.
template <typename Read>
auto reading(const fs::path& file, const Read& read) {
  return naming(file, [&] {
    std::error_code failed;
    if (!fs::exists(file, failed)) {
      throw InputError(
          file.string(), 0,
          "cannot be opened" + (failed ? ": " + failed.message() : "") + ", expected a map store");
    }
    const Database database(place_of(file), Database::Access::read);
    database.run("PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; BEGIN");
    if (!is_made(file, database))
      throw InputError(file.string(), 0, "is empty, expected a map store");
    const auto read_tables = [&](const Database& present) {
      return undamaged(file, [&] {
        Facts facts(present);
        return read(present, options_among(facts));
      });
    };
    if (!is_of_first_version(database)) return read_tables(database);
    const Database copy(":memory:", Database::Access::write);
    copy.take_over(database);
    upgrade(copy);
    return read_tables(copy);
  });
}

}  // namespace

MapBuilder read_builder(const fs::path& file) {
  return reading(file, [](const Database& database, const MapBuilderOptions& options) {
    return BuilderAccess::restored(MemoryRows(database).load(options), options);
  });
}

StoredMap read_map_store(const fs::path& file) {
  return reading(file, [](const Database& database, const MapBuilderOptions& options) {
    StoredMap stored;
    stored.map = BuilderAccess::restored(MemoryRows(database).load(options), options).map();
    stored.method = options.method;
    stored.sessions = sessions_in(database);
    stored.legs = legs_in(database);
    return stored;
  });
}

}  // namespace trussmap
