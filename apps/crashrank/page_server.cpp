#include "page_server.hpp"

#include <fmt/format.h>

#ifdef CRASHRANK_HAS_HTTPLIB
#include <httplib.h>
#include <sys/socket.h>
#endif

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace crashrank::cli {

#ifdef CRASHRANK_HAS_HTTPLIB

class PageServer::Listener {
public:
  Listener() : version_(milliseconds_now()) {
    // A connection serves one request, so that idle ones hold no thread.
    server_.set_keep_alive_max_count(1);
    server_.set_payload_max_length(0);
    // Not SO_REUSEPORT, with which two programs would share a port.
    server_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server_.set_default_headers({{"Cache-Control", "no-store"},
                                 {"X-Content-Type-Options", "nosniff"},
                                 {"X-Frame-Options", "DENY"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"}});
    server_.set_pre_routing_handler(
        [this](const httplib::Request& request, httplib::Response& answer) {
          if (is_own_host(request)) return httplib::Server::HandlerResponse::Unhandled;
          answer.status = 403;
          answer.set_content("The host is not this server's.\n", "text/plain");
          return httplib::Server::HandlerResponse::Handled;
        });
    server_.Get("/", [this](const httplib::Request& /*request*/, httplib::Response& answer) {
      const std::lock_guard<std::mutex> lock(mutex_);
      answer.set_content(page_, "text/html; charset=utf-8");
    });
    server_.Get("/version", [this](const httplib::Request& request, httplib::Response& answer) {
      answer.set_content(version_after(request.get_param_value("after")), "text/plain");
    });
  }

  ~Listener() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      is_closing_ = true;
    }
    changed_.notify_all();
    server_.stop();
    if (thread_.joinable()) thread_.join();
  }

  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Whether it listens.
  bool start(unsigned port) {
    constexpr const char* host = "127.0.0.1";
    const int bound = port == 0 ? server_.bind_to_any_port(host)
                      : server_.bind_to_port(host, static_cast<int>(port)) ? static_cast<int>(port)
                                                                           : -1;
    if (bound <= 0) return false;
    port_ = bound;
    thread_ = std::thread([this] {
      server_.listen_after_bind();
      has_ended_ = true;
    });
    // Stopping has no effect before.
    while (!server_.is_running() && !has_ended_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return !has_ended_;
  }

  int port() const { return port_; }

  std::uint64_t next_version() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return version_ + 1;
  }

  void publish(std::string page) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      page_ = std::move(page);
      ++version_;
    }
    changed_.notify_all();
  }

private:
  static std::uint64_t milliseconds_now() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
  }

  bool is_own_host(const httplib::Request& request) const {
    if (request.get_header_value_count("Host") != 1) return false;
    const std::string host = request.get_header_value("Host");
    return host == fmt::format("127.0.0.1:{}", port_) || host == fmt::format("localhost:{}", port_);
  }

  std::string version_after(const std::string& known) {
    constexpr std::chrono::seconds patience(20);
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, patience,
                      [&] { return is_closing_ || std::to_string(version_) != known; });
    return std::to_string(version_);
  }

  httplib::Server server_;
  std::thread thread_;
  int port_ = 0;
  std::atomic<bool> has_ended_{false};
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::string page_;
  std::uint64_t version_;
  bool is_closing_ = false;
};

Result<PageServer> PageServer::start(unsigned port) {
  auto listener = std::make_unique<Listener>();
  if (!listener->start(port)) {
    return make_error(ErrorCode::usage,
                      port == 0 ? std::string("no port of 127.0.0.1 can be listened on")
                                : fmt::format("port {} of 127.0.0.1 cannot be listened on", port),
                      port == 0 ? "let the system allow servers on this machine"
                                : "leave out --port, or name another one from 1024 on");
  }
  return PageServer(std::move(listener));
}

std::string PageServer::url() const {
  return fmt::format("http://127.0.0.1:{}/", listener_->port());
}
std::uint64_t PageServer::next_version() const { return listener_->next_version(); }
void PageServer::publish(std::string page) { listener_->publish(std::move(page)); }

#else

class PageServer::Listener {};

Result<PageServer> PageServer::start(unsigned /*port*/) {
  return make_error(ErrorCode::usage,
                    "this program was built without cpp-httplib, which serves pages",
                    "install libcpp-httplib-dev and build again, or write a file with crashrank "
                    "rank --report");
}

std::string PageServer::url() const { return {}; }
std::uint64_t PageServer::next_version() const { return 0; }
void PageServer::publish(std::string /*page*/) {}

#endif

PageServer::PageServer(std::unique_ptr<Listener> listener) : listener_(std::move(listener)) {}
PageServer::PageServer(PageServer&&) noexcept = default;
PageServer& PageServer::operator=(PageServer&&) noexcept = default;
PageServer::~PageServer() = default;

}  // namespace crashrank::cli
