#pragma once

#include "crashrank/base/result.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace crashrank::cli {

/// Serves one page to browsers of this machine while it lives, on 127.0.0.1: "/" answers the page,
/// "/version?after=N" its version as soon as that is not N, and after 20 s in any case. Nothing
/// else is served, and no request whose Host is not 127.0.0.1 or localhost with the port, so that
/// no page of another site can read this one under a name of its own.
class PageServer {
public:
  /// Listens on a port from 1 to 65535, or a free one for 0. Errors: usage for a port that cannot
  /// be listened on, or in a program that was built without cpp-httplib.
  static Result<PageServer> start(unsigned port);

  PageServer(PageServer&&) noexcept;
  PageServer& operator=(PageServer&&) noexcept;
  ~PageServer();

  /// "http://127.0.0.1:8000/"
  std::string url() const;
  /// The version of the page that is published next. It rises, also from one server to the next.
  std::uint64_t next_version() const;
  /// Replaces the page and wakes those who wait for its version. Safe from any thread.
  void publish(std::string page);

private:
  class Listener;
  explicit PageServer(std::unique_ptr<Listener> listener);

  std::unique_ptr<Listener> listener_;
};

}  // namespace crashrank::cli
