// SPDX-License-Identifier: Apache-2.0
#include "study/queue/study_queue.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <soci/postgresql/soci-postgresql.h>
#include <soci/soci.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <type_traits>

#include "phalanx/record/made.h"
#include "study/laboratory/fingerprint.h"
#include "study/laboratory/study_json.h"
#include "study/queue/queue_address.h"

namespace phalanx {
namespace {

constexpr int kFormat = 2;
constexpr double kLongestLease = 86400.0;  // [s]
constexpr auto kToldAgain = std::chrono::minutes(5);

using Clock = std::chrono::steady_clock;

constexpr const char* kTables[] = {
    "CREATE SCHEMA IF NOT EXISTS phalanx",
    "CREATE TABLE IF NOT EXISTS phalanx.format (version integer NOT NULL)",
    R"(CREATE TABLE IF NOT EXISTS phalanx.studies (
      id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
      fingerprint text NOT NULL UNIQUE, name text NOT NULL, header text NOT NULL, libm text NOT NULL,
      lease_s double precision NOT NULL, made timestamptz NOT NULL DEFAULT clock_timestamp()))",
    R"(CREATE TABLE IF NOT EXISTS phalanx.workers (
      id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
      study bigint NOT NULL REFERENCES phalanx.studies ON DELETE CASCADE,
      host text NOT NULL, place text NOT NULL, cpu text NOT NULL, jobs integer NOT NULL,
      seen timestamptz NOT NULL DEFAULT clock_timestamp(), ended timestamptz))",
    R"(CREATE TABLE IF NOT EXISTS phalanx.points (
      study bigint NOT NULL REFERENCES phalanx.studies ON DELETE CASCADE, point integer NOT NULL,
      failures integer NOT NULL DEFAULT 0, failed_on text, failed_at timestamptz, worker bigint, lease_end timestamptz,
      seconds double precision, finished_at timestamptz, result text, log text,
      PRIMARY KEY (study, point)) WITH (fillfactor = 70, autovacuum_vacuum_scale_factor = 0.01))",
    R"(CREATE INDEX IF NOT EXISTS points_unfinished ON phalanx.points (study, point) WHERE result IS NULL)",
    R"(CREATE INDEX IF NOT EXISTS points_finished ON phalanx.points (study, finished_at, point)
      WHERE result IS NOT NULL)"};

// A lease that is not over counts. After a start of the server every lease counts for its whole length again: the
// workers could not renew it while the server was away.
// A point that failed is left to other machines for a lease, if a worker of one lives: the machine may be the cause.
// Materialized: a plan that executed the selection for each row would take more than `most`.
constexpr const char* kTake = R"(WITH next AS MATERIALIZED (
    SELECT point FROM phalanx.points
    WHERE study = :study AND result IS NULL AND failures < :most_failures
      AND (lease_end IS NULL OR (lease_end < clock_timestamp() AND
           pg_postmaster_start_time() + make_interval(secs => CAST(:lease AS double precision)) < clock_timestamp()))
      AND (failed_on IS DISTINCT FROM (SELECT host FROM phalanx.workers WHERE id = :worker)
        OR failed_at + make_interval(secs => CAST(:lease AS double precision)) < clock_timestamp()
        OR NOT EXISTS (
           SELECT 1 FROM phalanx.workers WHERE workers.study = :study AND ended IS NULL
             AND host <> (SELECT host FROM phalanx.workers WHERE id = :worker)
             AND greatest(seen, pg_postmaster_start_time())
               + make_interval(secs => CAST(:lease AS double precision)) > clock_timestamp()))
    ORDER BY point LIMIT :most FOR UPDATE SKIP LOCKED)
  UPDATE phalanx.points
  SET worker = :worker, lease_end = clock_timestamp() + make_interval(secs => CAST(:lease AS double precision))
  FROM next WHERE points.study = :study AND points.point = next.point
  RETURNING points.point)";

// Stores only if the study still has the libm of what is stored: another worker may have set its own while this one
// was cut off. The key's lock waits for claim_libm(), but not for another kFinish.
// @returns one row: whether the study is there, whether it has this libm, and a point that had another result, with
// where that was measured; -1: none.
constexpr const char* kFinish = R"(WITH sent AS MATERIALIZED (
    SELECT * FROM json_to_recordset(CAST(:sent AS json)) AS row (point integer, seconds double precision, result text)),
  bound AS MATERIALIZED (SELECT id FROM phalanx.studies WHERE id = :study AND libm = :libm FOR KEY SHARE),
  stored AS (
    UPDATE phalanx.points SET result = sent.result, seconds = sent.seconds, worker = :worker, lease_end = NULL,
      finished_at = clock_timestamp()
    FROM sent, bound WHERE points.study = bound.id AND points.point = sent.point AND points.result IS NULL),
  other AS (
    SELECT points.point, coalesce(workers.place, 'a journal') AS place
    FROM sent, phalanx.points LEFT JOIN phalanx.workers ON workers.id = points.worker
    WHERE points.study = :study AND points.point = sent.point AND points.result <> sent.result
    ORDER BY points.point LIMIT 1)
  SELECT CAST((SELECT count(*) FROM phalanx.studies WHERE id = :study) AS integer),
    CAST((SELECT count(*) FROM bound) AS integer),
    coalesce((SELECT point FROM other), -1), coalesce((SELECT place FROM other), ''))";

// ORDER BY names the columns, not the text, so that the index points_finished has the order.
constexpr const char* kCollect =
    R"(SELECT result, CAST(points.finished_at AS text) AS finished_text, point,
    (SELECT libm FROM phalanx.studies WHERE id = :study) FROM phalanx.points
  WHERE study = :study AND result IS NOT NULL
    AND (points.finished_at, points.point) > (CAST(:after AS timestamptz), :point)
  ORDER BY points.finished_at, points.point LIMIT :most)";

std::string array_text(const std::vector<int>& points) {
  return fmt::format("{{{}}}", fmt::join(points, ","));
}

/// What PostgreSQL takes as text: no control characters but the line's end, no bytes that might be half a letter.
std::string plain(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return (c < 32 && c != '\n' && c != '\t') || c > 126; },
      '?');
  return text;
}

/// The reason in one line. It does not hold the statement.
std::string reason_of(const soci::soci_error& error) {
  std::string line;
  for (const char c : error.get_error_message()) {
    const bool blank = static_cast<unsigned char>(c) <= ' ';
    if (!blank || (!line.empty() && line.back() != ' ')) line += blank ? ' ' : c;
  }
  while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
  return line;
}

/// @returns what to do about a refusal, or an empty text.
std::string remedy_of(const std::string& why) {
  if (why.find("no password supplied") != std::string::npos)
    return "; write a line HOST:PORT:DATABASE:USER:PASSWORD into ~/.pgpass and make it readable by you alone";
  if (why.find("root certificate file") != std::string::npos)
    return "; put the certificate of the server's authority there, or name its file in the address "
           "(?sslrootcert=FILE)";
  if (why.find("permission denied for database") != std::string::npos)
    return "; the role makes the schema phalanx the first time: let its administrator make the role the "
           "database's owner (createdb --owner)";
  if (why.find("permission denied") != std::string::npos)
    return "; connect as the role that owns the tables of the schema phalanx, or let its owner grant the "
           "role what it needs";
  return "";
}

/// @throws std::invalid_argument
[[noreturn]] void refuse_libm(bool of_journal) {
  throw std::invalid_argument(fmt::format(
      "{} sine, exponential or another mathematical function rounds differently from that of the machines "
      "that measured points of the study, so that results would differ; {}, or measure all again on one "
      "type of machine (phalanx study run --restart)",
      of_journal ? "the points of the journal were measured on a machine whose" : "this machine's",
      of_journal ? "use another --out folder"
                 : "work on machines with the same processor type and the same libm"));
}

std::string host_here() {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  return plain(host.data());
}

std::string header_text_of(const JournalHeader& header) {
  return journal_text({.header = header, .points = {}});
}

/// @returns how the header that the queue has differs from this one.
std::string difference_of(const std::string& queued, const JournalHeader& header) {
  std::string why;
  try {
    why = difference(parse_journal(queued, "the queue").header, header);
  } catch (const std::invalid_argument&) {  // of a version with other keys
  }
  return why.empty() ? "it was begun by another version of the program" : why;
}

/// @param studies  number of rows that the study has
void refuse_removed(int studies) {
  if (studies == 0)
    throw std::runtime_error("the study was removed from the queue; begin it again with phalanx study run");
}

std::string fingerprint_of(const std::string& header) {
  Fingerprint fingerprint;
  fingerprint.add(header);
  return fingerprint.text();
}

}  // namespace

struct StudyQueue::Session {
  soci::session sql;

  explicit Session(const std::string& connection) {
    sql.open(soci::postgresql, connection);
    PQsetNoticeProcessor(server(), [](void*, const char*) {}, nullptr);  // errors are exceptions as well
  }

  [[nodiscard]] PGconn* server() {
    auto* backend = static_cast<soci::postgresql_session_backend*>(sql.get_backend());
    return backend != nullptr ? backend->conn_ : nullptr;
  }

  /// The server, or the way to it, is gone, ends, starts or has no room; the statement itself may be right.
  [[nodiscard]] bool is_lost(const soci::soci_error& error) {
    if (PQstatus(server()) != CONNECTION_OK) return true;
    const auto* of_server = dynamic_cast<const soci::postgresql_soci_error*>(&error);
    if (of_server == nullptr) return false;
    const std::string state = of_server->sqlstate();
    const bool from_server = !state.empty() && state.front() != ' ';  // else from libpq: a broken connection
    return !from_server || std::any_of(std::begin(kPassing), std::end(kPassing),
                                       [&](std::string_view passing) { return state.starts_with(passing); });
  }

  // Connection, resources, deadlock, intervention of an operator, a lock that was not free:
  // postgresql.org/docs/15/errcodes-appendix.html
  static constexpr std::string_view kPassing[] = {"08", "53", "40", "57P", "55P03"};
};

StudyQueue::StudyQueue(const QueueServer& server)
    : server_(server),
      connection_(queue_connection(server.url)),
      libm_(libm_text()),
      worker_host_(host_here()),
      worker_place_(fmt::format("{} {}", worker_host_, ::getpid())) {
  try {
    session_ = std::make_unique<Session>(connection_);
  } catch (const soci::soci_error& error) {
    const std::string why = reason_of(error);
    throw std::runtime_error(fmt::format("the queue's server cannot be reached: {}{}", why, remedy_of(why)));
  }
}

StudyQueue::~StudyQueue() = default;

/// Calls `function` with a session until it succeeds.
template <class Function>
auto StudyQueue::attempt(const Function& function) {
  std::string told;
  Clock::time_point next_told;
  for (int tries = 0;; ++tries) {
    std::string why;
    try {
      if (!session_) session_ = std::make_unique<Session>(connection_);
      if constexpr (std::is_void_v<decltype(function(*session_))>) {
        function(*session_);
        tell_back(told);
        return;
      } else {
        auto result = function(*session_);
        tell_back(told);
        return result;
      }
    } catch (const soci::soci_error& error) {
      why = reason_of(error);
      if (session_ && !session_->is_lost(error))
        throw std::runtime_error(
            fmt::format("the queue's server refuses a statement: {}{}", why, remedy_of(why)));
    }
    session_.reset();
    // Not the first time: a new connection may be all that is needed. Later a password may be wrong by now.
    if (tries > 0 && (why != told || Clock::now() >= next_told)) {
      if (server_.tell)
        server_.tell(fmt::format("the queue's server is away ({}{}); trying again until it is back", why,
                                 remedy_of(why)));
      told = why;
      next_told = Clock::now() + kToldAgain;
    }
    wait_for_server(tries);
  }
}

/// @param told  why it was away; empty: that was not told
void StudyQueue::tell_back(const std::string& told) const {
  if (!told.empty() && server_.tell) server_.tell("the queue's server is back");
}

void StudyQueue::try_though_stopped() { tries_until_ = Clock::now() + std::chrono::seconds(3); }

void StudyQueue::wait_for_server(int tries) const {
  constexpr int kMostDoublings = 5;
  constexpr auto kStep = std::chrono::milliseconds(100);
  for (int step = 0; step < 1 << std::min(tries, kMostDoublings); ++step) {
    if (Clock::now() >= tries_until_ && server_.stopped && server_.stopped()) throw QueueStopped{};
    std::this_thread::sleep_for(kStep);
  }
}

/// Not in the transaction that fills them: these statements lock the tables of all studies.
void StudyQueue::make_tables() {
  attempt([](Session& session) {
    soci::session& sql = session.sql;
    soci::transaction transaction(sql);
    int tables = 0;
    sql << "SELECT count(*) FROM pg_tables WHERE schemaname = 'phalanx' AND tablename = 'points'",
        soci::into(tables);
    if (tables > 0) return;
    long long locked = 0;  // two that create at the same time; the number is of this program alone
    sql << "SELECT count(pg_advisory_xact_lock(5043161847312905))", soci::into(locked);
    for (const char* table : kTables) sql << table;
    sql << "INSERT INTO phalanx.format SELECT :version WHERE NOT EXISTS (SELECT 1 FROM phalanx.format)",
        soci::use(kFormat, "version");
    transaction.commit();
  });
}

void StudyQueue::prepare(double lease_s) {
  if (!(lease_s > 0.0 && lease_s <= kLongestLease))
    throw std::invalid_argument(fmt::format(
        "a lease of {} s is out of range; give one above 0 and up to {} s", lease_s, kLongestLease));
  make_tables();
  int version = 0;
  attempt([&](Session& session) {
    session.sql << "SELECT max(version) FROM phalanx.format", soci::into(version);
  });
  if (version != kFormat)
    throw std::runtime_error(fmt::format(
        "the queue's tables have format {}, this program knows {}; use the program that made them, or "
        "another database",
        version, kFormat));
}

void StudyQueue::create(const JournalHeader& header, double lease_s, bool restart) {
  prepare(lease_s);
  const std::string text = header_text_of(header);
  const std::string fingerprint = fingerprint_of(text);
  const std::string name = plain(header.study.name);
  const int points = point_count(header.study);
  long long old = 0;  // the study that a restart removes; what a repetition finds was made by this call
  if (restart)
    attempt([&](Session& session) {
      session.sql << "SELECT coalesce(max(id), 0) FROM phalanx.studies WHERE fingerprint = :key",
          soci::into(old), soci::use(fingerprint, "key");
    });
  attempt([&](Session& session) {
    soci::session& sql = session.sql;
    soci::transaction transaction(sql);
    sql << "DELETE FROM phalanx.studies WHERE id = :old", soci::use(old, "old");
    sql << R"(WITH made AS (
                INSERT INTO phalanx.studies (fingerprint, name, header, libm, lease_s)
                VALUES (:key, :name, :header, '', :lease) ON CONFLICT (fingerprint) DO NOTHING RETURNING id)
              INSERT INTO phalanx.points (study, point)
              SELECT id, point FROM made, generate_series(0, CAST(:points AS integer) - 1) AS point)",
        soci::use(fingerprint, "key"), soci::use(name, "name"), soci::use(text, "header"),
        soci::use(lease_s, "lease"), soci::use(points, "points");
    sql << "UPDATE phalanx.studies SET lease_s = :lease WHERE fingerprint = :key",
        soci::use(lease_s, "lease"), soci::use(fingerprint, "key");
    transaction.commit();
  });
  attempt([&](Session& session) { find_study(session, header); });
  refuse_removed(study_ == 0 ? 0 : 1);
}

/// Sets study_, or leaves it 0.
void StudyQueue::find_study(Session& session, const JournalHeader& header) {
  const std::string fingerprint = fingerprint_of(header_text_of(header));
  study_ = 0;
  session.sql << "SELECT id, lease_s FROM phalanx.studies WHERE fingerprint = :key", soci::into(study_),
      soci::into(lease_s_), soci::use(fingerprint, "key");
  if (!session.sql.got_data()) study_ = 0;
}

/// Compares libm_ with the study's, which it sets if no result and no living worker depends on it. Keeps the study's
/// row locked until the transaction ends.
void StudyQueue::claim_libm(Session& session, bool of_journal) {
  std::string known = libm_;
  int bound = 0;
  session.sql << "SELECT libm FROM phalanx.studies WHERE id = :study FOR UPDATE", soci::into(known),
      soci::use(study_, "study");
  if (!session.sql.got_data() || known == libm_) return;
  session.sql << R"(SELECT CAST(
        EXISTS (SELECT 1 FROM phalanx.points WHERE study = :study AND result IS NOT NULL) OR
        EXISTS (SELECT 1 FROM phalanx.workers WHERE study = :study AND ended IS NULL
                AND greatest(seen, pg_postmaster_start_time())
                  + make_interval(secs => CAST(:lease AS double precision)) > clock_timestamp()) AS integer))",
      soci::into(bound), soci::use(study_, "study"), soci::use(lease_s_, "lease");
  if (bound != 0) refuse_libm(of_journal);
  session.sql << "UPDATE phalanx.studies SET libm = :libm WHERE id = :study", soci::use(libm_, "libm"),
      soci::use(study_, "study");
}

void StudyQueue::claim_for_journal(const std::string& libm) {
  if (!libm.empty()) libm_ = libm;
  attempt([&](Session& session) {
    soci::transaction transaction(session.sql);
    claim_libm(session, true);
    transaction.commit();
  });
}

void StudyQueue::join(const JournalHeader& header, int jobs) {
  std::string other;
  const std::string name = plain(header.study.name);
  attempt([&](Session& session) {
    int tables = 0;
    other.clear();
    session.sql << "SELECT count(*) FROM pg_tables WHERE schemaname = 'phalanx' AND tablename = 'points'",
        soci::into(tables);
    if (tables == 0) return;
    find_study(session, header);
    if (study_ != 0) return;
    session.sql << "SELECT header FROM phalanx.studies WHERE name = :name ORDER BY id DESC LIMIT 1",
        soci::into(other), soci::use(name, "name");
    if (!session.sql.got_data()) other.clear();
  });
  if (study_ == 0) {
    std::string why = "it has no study of this name";
    if (!other.empty()) why = difference_of(other, header);
    throw std::invalid_argument(fmt::format(
        "the queue does not have this study: {}; begin it with this program and file: phalanx study run "
        "FILE --queue URL --out DIR",
        why));
  }
  const std::string cpu = plain(made_here().cpu);
  attempt([&](Session& session) {
    soci::transaction transaction(session.sql);
    claim_libm(session, false);
    session.sql << R"(INSERT INTO phalanx.workers (study, host, place, cpu, jobs)
                      VALUES (:study, :host, :place, :cpu, :jobs) RETURNING id)",
        soci::into(worker_), soci::use(study_, "study"), soci::use(worker_host_, "host"),
        soci::use(worker_place_, "place"), soci::use(cpu, "cpu"), soci::use(jobs, "jobs");
    transaction.commit();
  });
}

void StudyQueue::retry_quarantined() {
  attempt([&](Session& session) {
    session.sql << "UPDATE phalanx.points SET failures = 0, failed_on = NULL, log = NULL WHERE study = "
                   ":study AND result IS NULL AND failures > 0",
        soci::use(study_, "study");
  });
}

std::vector<int> StudyQueue::take(int most) {
  return attempt([&](Session& session) {
    const soci::rowset<int> rows =
        (session.sql.prepare << kTake, soci::use(worker_, "worker"), soci::use(lease_s_, "lease"),
         soci::use(study_, "study"), soci::use(kFailuresToQuarantine, "most_failures"),
         soci::use(most, "most"));
    std::vector<int> points(rows.begin(), rows.end());
    std::sort(points.begin(), points.end());
    return points;
  });
}

void StudyQueue::renew(const std::vector<int>& points) {
  const std::string list = array_text(points);
  attempt([&](Session& session) {
    session.sql << R"(WITH alive AS (UPDATE phalanx.workers SET seen = clock_timestamp() WHERE id = :worker)
                      UPDATE phalanx.points
                      SET lease_end = clock_timestamp() + make_interval(secs => CAST(:lease AS double precision))
                      WHERE study = :study AND worker = :worker AND result IS NULL
                        AND point = ANY (CAST(:list AS integer[])))",
        soci::use(worker_, "worker"), soci::use(lease_s_, "lease"), soci::use(study_, "study"),
        soci::use(list, "list");
  });
}

void StudyQueue::finish(const std::vector<MeasuredPoint>& measured) {
  if (measured.empty()) return;
  OrderedJson json = OrderedJson::array();
  for (const MeasuredPoint& point : measured)
    json.push_back({{"point", point.index}, {"seconds", point.seconds}, {"result", point.result}});
  const std::string sent = json.dump(-1, ' ', true, OrderedJson::error_handler_t::replace);
  int studies = 0;
  int bound = 0;
  int other = -1;
  std::string place;
  attempt([&](Session& session) {
    session.sql << kFinish, soci::into(studies), soci::into(bound), soci::into(other), soci::into(place),
        soci::use(sent, "sent"), soci::use(study_, "study"), soci::use(libm_, "libm"),
        soci::use(worker_, "worker");
  });
  refuse_removed(studies);
  if (bound == 0) refuse_libm(worker_ == 0);
  if (other >= 0)
    throw std::runtime_error(fmt::format(
        "point {} has another result in the queue already: this machine ({}) and that of the first "
        "result ({}) compute differently; compare them with phalanx study FILE on each",
        other, worker_place_, place));
}

void StudyQueue::fail(int point, const std::string& log) {
  const std::string text = plain(fmt::format("on {}: {}", worker_place_, log));
  attempt([&](Session& session) {
    session.sql << R"(UPDATE phalanx.points SET failures = failures + 1, worker = NULL, lease_end = NULL,
                        failed_on = (SELECT host FROM phalanx.workers WHERE id = :worker),
                        failed_at = clock_timestamp(), log = concat_ws(E'\n\n', log, CAST(:log AS text))
                      WHERE study = :study AND point = :point AND worker = :worker AND result IS NULL)",
        soci::use(text, "log"), soci::use(study_, "study"), soci::use(point, "point"),
        soci::use(worker_, "worker");
  });
}

void StudyQueue::give_back(const std::vector<int>& points) {
  const std::string list = array_text(points);
  attempt([&](Session& session) {
    session.sql << R"(UPDATE phalanx.points SET worker = NULL, lease_end = NULL
                      WHERE study = :study AND worker = :worker AND result IS NULL
                        AND point = ANY (CAST(:list AS integer[])))",
        soci::use(worker_, "worker"), soci::use(study_, "study"), soci::use(list, "list");
  });
}

void StudyQueue::leave(const std::vector<int>& points) {
  give_back(points);
  attempt([&](Session& session) {
    session.sql << "UPDATE phalanx.workers SET ended = clock_timestamp() WHERE id = :worker",
        soci::use(worker_, "worker");
  });
}

bool StudyQueue::has_unfinished() {
  int studies = 0;
  int unfinished = 0;
  attempt([&](Session& session) {
    session.sql << R"(SELECT (SELECT count(*) FROM phalanx.studies WHERE id = :study), count(*) FROM (
                        SELECT 1 FROM phalanx.points
                        WHERE study = :study AND result IS NULL AND failures < :most LIMIT 1) AS first)",
        soci::into(studies), soci::into(unfinished), soci::use(study_, "study"),
        soci::use(kFailuresToQuarantine, "most");
  });
  refuse_removed(studies);
  return unfinished > 0;
}

QueueState StudyQueue::state() {
  QueueState state;
  int studies = 0;
  attempt([&](Session& session) {
    session.sql << R"(SELECT (SELECT count(*) FROM phalanx.studies WHERE id = :study),
                        count(*) FILTER (WHERE failures < :most), count(*) FILTER (WHERE failures >= :most),
                        (SELECT count(*) FROM phalanx.workers WHERE study = :study AND ended IS NULL
                         AND greatest(seen, pg_postmaster_start_time())
                           + make_interval(secs => CAST(:lease AS double precision)) > clock_timestamp())
                      FROM phalanx.points WHERE study = :study AND result IS NULL)",
        soci::into(studies), soci::into(state.unfinished), soci::into(state.quarantined),
        soci::into(state.workers), soci::use(kFailuresToQuarantine, "most"), soci::use(study_, "study"),
        soci::use(lease_s_, "lease");
  });
  refuse_removed(studies);
  return state;
}

std::string StudyQueue::processors() {
  std::string names;
  attempt([&](Session& session) {
    session.sql
        << R"(SELECT coalesce(string_agg(DISTINCT cpu, '; '), '') FROM phalanx.workers WHERE study = :study)",
        soci::into(names), soci::use(study_, "study");
  });
  return names;
}

std::vector<QuarantinedPoint> StudyQueue::quarantined() {
  return attempt([&](Session& session) {
    std::vector<QuarantinedPoint> points;
    const soci::rowset<soci::row> rows =
        (session.sql.prepare << R"(SELECT point, coalesce(log, '') FROM phalanx.points
                                   WHERE study = :study AND result IS NULL AND failures >= :most ORDER BY point LIMIT :logs)",
         soci::use(study_, "study"), soci::use(kFailuresToQuarantine, "most"),
         soci::use(kMostQuarantinedLogs, "logs"));
    for (const soci::row& row : rows)
      points.push_back({.index = row.get<int>(0), .log = row.get<std::string>(1)});
    return points;
  });
}

void StudyQueue::collect(std::map<int, PointResult>& results) {
  constexpr int kPage = 2000;
  std::string after = collected_until_;
  int point = -1;
  for (;;) {
    const int rows_read = attempt([&](Session& session) {
      int count = 0;
      const soci::rowset<soci::row> rows =
          (session.sql.prepare << kCollect, soci::use(study_, "study"), soci::use(after, "after"),
           soci::use(point, "point"), soci::use(kPage, "most"));
      std::string last = after;
      int last_point = point;
      for (const soci::row& row : rows) {
        last = row.get<std::string>(1);
        last_point = row.get<int>(2);
        ++count;
        collected_libm_ = row.get<std::string>(3);
        if (results.contains(last_point)) continue;
        results.emplace(last_point, result_from_json(parse_json(row.get<std::string>(0))));
      }
      after = last;
      point = last_point;
      return count;
    });
    if (rows_read < kPage) break;
  }
  // A result may become visible a little after one with a later time.
  attempt([&](Session& session) {
    session.sql << "SELECT CAST(CAST(:after AS timestamptz) - make_interval(secs => 5) AS text)",
        soci::into(collected_until_), soci::use(after, "after");
  });
}

}  // namespace phalanx
