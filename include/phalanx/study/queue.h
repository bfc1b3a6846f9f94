// SPDX-License-Identifier: Apache-2.0
// A study on many machines. Its points are rows of a table in PostgreSQL: run_on_queue() makes them and collects
// the results, and any number of work_on_queue(), on any machines, take points and measure them.
//
// A point that is taken carries a lease, which its worker renews. If the worker is killed or cut off, the lease
// ends and another worker takes the point. A result is stored by one statement, and only once: a finished point
// is never taken again. Results are those of run_study().
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "phalanx/study/laboratory/run_study.h"
#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// The database, and what to do while it is away: a connection that is lost is made again, without end.
struct QueueServer {
  /// postgresql://USER@HOST/DATABASE, or postgresql:///DATABASE?host=/FOLDER for a socket. It must not contain a
  /// password; libpq takes one from ~/.pgpass. Over TCP the server's certificate is checked
  /// (sslmode=verify-full); only a server on the loopback interface may be used without.
  std::string url = {};
  std::function<bool()> stopped = {};  ///< asked several times a second; true: return in good order
  std::function<void(const std::string&)> tell = {};  ///< takes one sentence for people
};

/// Number of failures after which a point is quarantined: it is not tried again by itself.
inline constexpr int kFailuresToQuarantine = 3;

/// Number of quarantined points whose logs are read.
inline constexpr int kMostQuarantinedLogs = 100;

/// A point that was given up.
struct QuarantinedPoint {
  int index = 0;
  /// For each failure the machine, how the process ended or what was thrown, and the end of what it wrote.
  std::string log;
};

/// Options of run_on_queue().
struct QueueRunOptions {
  std::string commit = {};  ///< as StudyOptions::commit
  /// Time for which a taken point belongs to its worker unless that renews it [s], above 0. Workers that begin
  /// after this call use it.
  double lease_s = 60.0;
  bool restart = false;  ///< removes the study from the queue, and the journal's points, first
  bool retry = false;    ///< lets quarantined points be tried again
  std::function<void(const StudyProgress&)> progress =
      {};  ///< about once a second, for large studies less often
  /// Called with the results so far, by index, if there are new ones; at most every 5 s, and for at most about a
  /// twentieth of the time.
  std::function<void(const std::vector<PointResult>&, const StudyProgress&)> page = {};
};

/// What a queue holds of a study when run_on_queue() returns.
struct QueuedResults {
  std::vector<PointResult> results;           ///< by index
  std::vector<QuarantinedPoint> quarantined;  ///< by index, the first kMostQuarantinedLogs
  int quarantined_points = 0;                 ///< all of them
  std::string processors;                     ///< names of the workers' processors, each once; may be empty
  bool whole = false;                         ///< every point has a result
};

/// Puts a study into the queue, if it is not there, and collects results until every point is finished or
/// quarantined, or `stopped`. Points of a journal in `out` enter the queue as finished; they must have been measured
/// with mathematical functions that round as those of the workers. At the end the journal out/points.jsonl holds all
/// results, by index. Not real-time.
/// @throws SceneError, std::invalid_argument as run_study(); std::invalid_argument also for an address or a lease
/// that is refused, and if journal and queue have different results of a point, or of machines whose mathematical
/// functions round differently
/// @throws std::runtime_error if the server refuses the connection at first or a statement, the study is removed
/// from the queue, or a file cannot be written
[[nodiscard]] QueuedResults run_on_queue(const Study& study, const StudyCheck& check,
                                         const std::filesystem::path& out, const QueueServer& server,
                                         const QueueRunOptions& options);

/// Options of work_on_queue().
struct QueueWorkOptions {
  std::string commit = {};  ///< as StudyOptions::commit
  int jobs = 0;             ///< processes that measure; 0: as many as there are cores
  /// Longest time of a point [s], to about 1 s. Then its process is ended, and the point fails. 0:
  /// usual_point_limit()
  double limit_s = 0.0;
  /// Called after points were stored, with their number so far and the pace of the last minute [1/s]; NaN: not known.
  std::function<void(int done, double points_per_s)> finished = {};
};

/// What one worker did.
struct QueueWork {
  int finished = 0;    ///< points whose results it stored
  int failed = 0;      ///< times that a point's process crashed or a point took too long, or its trial threw
  bool whole = false;  ///< false: `stopped`
  bool given_back = false;  ///< the points that it still had; else the server was away, and their leases end
};

/// @returns an hour, or twenty times what the most trials of a point take at 0.05 s a trial, if that is longer [s].
[[nodiscard]] double usual_point_limit(const Study& study);

/// Takes points of the study and measures each in a child process, forked from this one, until no point is left
/// to any worker, or `stopped`; what was not measured is then given back. It takes as many points at once as its
/// processes measure in about 5 s, at most 1,000 and at least one a process. If a process crashes, its point fails
/// and the others go on. Not real-time; call it in a process without other threads.
/// @throws std::invalid_argument if the queue does not have the study, or has it of another study file, other
/// scene files, another program or a first worker whose mathematical functions round differently; and if the limit
/// is below 0
/// @throws std::runtime_error as run_on_queue(); if a point has another result already; if a file of the inputs was
/// changed since the call began (what was measured since is not stored); and after 20 failures without a result
/// between them, since the cause is then more likely this machine than the points
[[nodiscard]] QueueWork work_on_queue(const Study& study, const StudyCheck& check, const TrialFunction& trial,
                                      const QueueServer& server, const QueueWorkOptions& options);

}  // namespace phalanx
