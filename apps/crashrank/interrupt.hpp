#pragma once

#include <functional>
#include <string>

namespace crashrank::cli {

/// Runs a command's action on a thread of its own. The calling thread meanwhile draws the progress
/// and waits for SIGINT and SIGTERM: then it prints what `PartialAnswer` has, removes what
/// `UnfinishedFile` names and ends the process with exit_budget, without waiting for the action
/// unless that `EndsItself`.
/// Signals that the caller's caller ignores stay ignored. Rethrows what the action throws.
int run_interruptible(const std::function<int()>& action);

/// Whether a signal has come. What the action says of failures from then on is its effect: the
/// importer, for instance, gets the same Ctrl-C.
bool is_interrupted();

/// What an interruption leaves to say.
struct Interruption {
  std::string answer;   ///< for standard output; may be empty
  std::string message;  ///< for standard error: what the answer is, or what was not done
};

/// While it lives, an interruption asks it what is known. `tell` runs on another thread than the
/// work, which goes on, and has to return within 0.1 s; it may lock what the work holds for a
/// moment only. The one made last is asked.
class PartialAnswer {
public:
  explicit PartialAnswer(std::function<Interruption()> tell);
  ~PartialAnswer();
  PartialAnswer(const PartialAnswer&) = delete;
  PartialAnswer& operator=(const PartialAnswer&) = delete;
};

/// While it lives, the action asks `is_interrupted`, and ends by itself with what is known and a
/// message of its own: it has 2 s for that.
class EndsItself {
public:
  EndsItself();
  ~EndsItself();
  EndsItself(const EndsItself&) = delete;
  EndsItself& operator=(const EndsItself&) = delete;
};

/// A file, or a folder with all in it, that an interruption removes. To be made before the file is.
class UnfinishedFile {
public:
  explicit UnfinishedFile(std::string path);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

private:
  std::string path_;
};

}  // namespace crashrank::cli
