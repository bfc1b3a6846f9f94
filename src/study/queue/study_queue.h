// SPDX-License-Identifier: Apache-2.0
// The tables of the queue. All SQL is here.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "phalanx/study/queue.h"
#include "study/laboratory/journal.h"

namespace phalanx {

/// A measured point on its way into the queue.
struct MeasuredPoint {
  int index = 0;
  double seconds = 0.0;  ///< time that it took [s]
  std::string result;    ///< result_line() without its end
};

/// Counts of a study in the queue.
struct QueueState {
  int unfinished = 0;  ///< points that have neither a result nor are quarantined
  int quarantined = 0;
  int workers = 0;  ///< seen within the lease
};

/// One study in a database of PostgreSQL, over one connection. A call that loses the connection is repeated on a
/// new one: every statement may be executed twice. For one thread. All functions throw std::runtime_error if the
/// server refuses a statement, and QueueStopped if the connection is away and `stopped`.
class StudyQueue {
 public:
  /// Connects. @throws std::invalid_argument if the address is refused; std::runtime_error with libpq's reason
  explicit StudyQueue(const QueueServer& server);
  ~StudyQueue();
  StudyQueue(const StudyQueue&) = delete;
  StudyQueue& operator=(const StudyQueue&) = delete;

  /// Makes tables that are not there; changes no study.
  /// @throws std::invalid_argument if the lease is out of range; std::runtime_error if the tables have another format
  void prepare(double lease_s);
  /// Makes tables, study and points that are not there. @param restart  the study and its points are made again
  void create(const JournalHeader& header, double lease_s, bool restart);
  /// Lets quarantined points be tried again.
  void retry_quarantined();
  /// Makes the study's mathematical functions, and those of what finish() stores, the ones of a journal, before its
  /// points enter the queue. @param libm  of the journal; empty: this machine's
  /// @throws std::invalid_argument if points were measured with others
  void claim_for_journal(const std::string& libm);
  /// @returns libm_text() of the machines that measured what collect() added; empty if it added nothing.
  [[nodiscard]] const std::string& collected_libm() const noexcept { return collected_libm_; }
  /// @returns the processors of the workers, each once, or an empty text.
  [[nodiscard]] std::string processors();
  /// Makes this connection a worker's. @throws std::invalid_argument as work_on_queue()
  void join(const JournalHeader& header, int jobs);

  /// Takes up to `most` points, lowest first, that have no result and no valid lease. A point that failed on this
  /// machine is left to other machines for a lease, if a worker of one lives.
  [[nodiscard]] std::vector<int> take(int most);
  /// Renews the leases of these points of this worker.
  void renew(const std::vector<int>& points);
  /// Stores results; a point that has one keeps it.
  /// @throws std::runtime_error if that one differs (two that are stored at the same moment are not compared), or if
  /// the study was removed; std::invalid_argument if its points are by now measured with mathematical functions that
  /// round differently
  void finish(const std::vector<MeasuredPoint>& measured);
  /// Counts a failure of a point of this worker, adds the machine and `log` to the point's log, and gives the point
  /// back.
  void fail(int point, const std::string& log);
  /// Gives these points of this worker back.
  void give_back(const std::vector<int>& points);
  /// Gives these points back, and ends this worker.
  void leave(const std::vector<int>& points);
  /// @returns the time between two renewals [s]
  [[nodiscard]] double renewal_s() const noexcept { return lease_s_ / 3.0; }

  /// @returns whether a point has neither a result nor is quarantined. @throws std::runtime_error if the study was
  /// removed
  [[nodiscard]] bool has_unfinished();
  /// @throws std::runtime_error if the study was removed
  [[nodiscard]] QueueState state();
  /// @returns the first kMostQuarantinedLogs.
  [[nodiscard]] std::vector<QuarantinedPoint> quarantined();
  /// Lets calls try for 3 s from now, also if `stopped`. An attempt to connect that has begun may take 10 s more.
  void try_though_stopped();
  /// Adds the results that were stored since the last call, and some of those before, to `results`.
  void collect(std::map<int, PointResult>& results);
  /// Makes the next collect() begin from the first result.
  void collect_all() { collected_until_ = "-infinity"; }

 private:
  struct Session;
  template <class Function>
  auto attempt(const Function& function);
  void make_tables();
  void tell_back(const std::string& told) const;
  void wait_for_server(int tries) const;
  void find_study(Session& session, const JournalHeader& header);
  void claim_libm(Session& session, bool of_journal);

  QueueServer server_;
  std::string connection_;
  std::unique_ptr<Session> session_;
  std::string libm_;            ///< of what finish() stores
  std::string collected_libm_;  ///< of what collect() added
  std::string worker_host_;
  std::string worker_place_;
  long long study_ = 0;
  long long worker_ = 0;
  double lease_s_ = 0.0;
  std::chrono::steady_clock::time_point tries_until_{};  ///< until then `stopped` has no effect
  std::string collected_until_ = "-infinity";
};

/// The caller asked to stop while the server was away.
struct QueueStopped {};

}  // namespace phalanx
