#include "crashrank/mesh/import.hpp"

#include "mesh/import_protocol.hpp"
#include "mesh/mesh_writers.hpp"
#include "mesh/scratch_dir.hpp"

#include <gtest/gtest.h>

#include <dirent.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

// Importers that misbehave: each is a shell script in place of the real one.
namespace crashrank {
namespace {

using test::ScratchDir;

class ImporterProcess : public testing::Test {
protected:
  ImporterProcess() : mesh_(dir_.write("a.obj", test::as_obj(test::eighths_soup()))) {}

  Result<ImportedMesh> import_by(const std::string& script) {
    ImportOptions options;
    options.importer = dir_.write("importer", "#!/bin/sh\n" + script + "\n");
    ::chmod(options.importer.c_str(), 0700);
    options.limits.seconds = 0.3;
    return import_mesh(mesh_, options);
  }

  // An importer that answers with these bytes.
  Result<ImportedMesh> import_answered(const std::string& bytes) {
    return import_by("cat '" + dir_.write("answer", bytes) + "'");
  }

  ScratchDir dir_;
  std::string mesh_;
};

template <class T> void put(std::string& bytes, const T& value) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes.append(raw.data(), raw.size());
}

struct Answer {
  detail::ImportHeader header;
  std::string name = "part";
  std::uint32_t part_triangles = 1;
  std::array<float, 9> vertices{0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::array<std::uint32_t, 3> triangle{0, 1, 2};
  std::uint64_t trailer = detail::import_trailer;

  Answer() {
    header.parts = 1;
    header.vertices = 3;
    header.triangles = 1;
  }
  std::string bytes() const {
    std::string out;
    put(out, header);
    put(out, part_triangles);
    put(out, static_cast<std::uint32_t>(name.size()));
    out += name;
    put(out, vertices);
    put(out, triangle);
    put(out, trailer);
    return out;
  }
};

std::size_t open_descriptors() {
  std::size_t count = 0;
  DIR* folder = ::opendir("/proc/self/fd");
  while (folder != nullptr && ::readdir(folder) != nullptr) ++count;
  if (folder != nullptr) ::closedir(folder);
  return count;
}

void expect_no_children() {
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST_F(ImporterProcess, WellFormedAnswersAreBelieved) {
  const Result<ImportedMesh> imported = import_answered(Answer().bytes());
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  EXPECT_EQ(imported->mesh.size(), 1U);
  EXPECT_EQ(imported->mesh.parts[0].name, "part");
}

TEST_F(ImporterProcess, AnswersThatContradictThemselvesAreNot) {
  std::vector<std::pair<const char*, std::string>> lies;
  const auto lie = [&](const char* what, auto change) {
    Answer answer;
    change(answer);
    lies.emplace_back(what, answer.bytes());
  };
  lie("magic", [](Answer& a) { a.header.magic[0] = 'x'; });
  lie("version", [](Answer& a) { ++a.header.version; });
  lie("status", [](Answer& a) { a.header.status = detail::ImportStatus{77}; });
  lie("too many vertices", [](Answer& a) { a.header.vertices = ~std::uint64_t{0}; });
  lie("too many triangles", [](Answer& a) { a.header.triangles = std::uint64_t{1} << 40; });
  lie("too many parts", [](Answer& a) { a.header.parts = std::uint64_t{1} << 40; });
  lie("too many warnings", [](Answer& a) { a.header.warnings = 1000; });
  lie("index", [](Answer& a) { a.triangle[1] = 3; });
  lie("not finite", [](Answer& a) { a.vertices[4] = std::numeric_limits<float>::infinity(); });
  lie("part too long", [](Answer& a) { a.part_triangles = 2; });
  lie("part empty", [](Answer& a) { a.part_triangles = 0; });
  lie("long name", [](Answer& a) { a.name.assign(max_part_name_bytes + 1, 'a'); });
  lie("name not UTF-8", [](Answer& a) { a.name = "\xff"; });
  lie("trailer", [](Answer& a) { a.trailer = 0; });
  lie("more promised than sent", [](Answer& a) { a.header.vertices = 1'000'000; });
  const std::string whole = Answer().bytes();
  for (std::size_t cut = 0; cut < whole.size(); cut += 7)
    lies.emplace_back("cut", whole.substr(0, cut));
  for (const auto& [what, bytes] : lies) {
    SCOPED_TRACE(what);
    EXPECT_FALSE(import_answered(bytes).ok());
  }
  expect_no_children();
}

TEST_F(ImporterProcess, RefusalsComeThroughInOneLine) {
  std::string bytes;
  detail::ImportHeader header;
  header.status = detail::ImportStatus::bad_input;
  put(bytes, header);
  for (const std::string text : {"face 7", "it is\nbroken\x1b[31m", "mend it"}) {
    put(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += text;
  }
  put(bytes, detail::import_trailer);
  const Result<ImportedMesh> imported = import_answered(bytes);
  ASSERT_FALSE(imported.ok());
  EXPECT_EQ(imported.error().message(), mesh_ + ": face 7: it is\\x0abroken\\x1b[31m; mend it");
}

TEST_F(ImporterProcess, AHangingImporterIsKilledAtTheDeadline) {
  for (const char* script :
       {"exec sleep 100", "exec sleep 100 >&-", "trap '' TERM; exec sleep 100"}) {
    const auto start = std::chrono::steady_clock::now();
    const Result<ImportedMesh> imported = import_by(script);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    EXPECT_FALSE(imported.ok());
    // The bound is generous: what is tested is that it is not the 100 seconds.
    EXPECT_LT(took.count(), 50.0);
    expect_no_children();
  }
  EXPECT_EQ(import_by("exec sleep 100").error().code, ErrorCode::limit_exceeded);
}

TEST_F(ImporterProcess, TheWayItEndedIsTold) {
  EXPECT_NE(import_by("kill -SEGV $$").error().reason.find("SIGSEGV"), std::string::npos);
  EXPECT_EQ(import_by("kill -SEGV $$").error().code, ErrorCode::bad_input);
  const std::string ended = import_by("kill -ABRT $$").error().message();
  EXPECT_NE(ended.find("the parser failed on it"), std::string::npos) << ended;
  EXPECT_NE(ended.find("something that the parser does not know"), std::string::npos) << ended;
  EXPECT_EQ(import_by("kill -XCPU $$").error().code, ErrorCode::limit_exceeded);
  const Error failed = import_by("echo 'libassimp.so: no such file' >&2; exit 127").error();
  EXPECT_EQ(failed.code, ErrorCode::internal);
  EXPECT_NE(failed.reason.find("libassimp.so: no such file"), std::string::npos);
  expect_no_children();
}

TEST_F(ImporterProcess, AFloodOnStandardErrorIsDrained) {
  EXPECT_FALSE(import_by("yes error | head -c 10000000 >&2; exit 3").ok());
  expect_no_children();
}

TEST_F(ImporterProcess, WhatCannotBeRunIsSaid) {
  ImportOptions options;
  options.importer = (dir_.path() / "none").string();
  EXPECT_EQ(import_mesh(mesh_, options).error().code, ErrorCode::internal);
  options.importer = mesh_;  // not executable
  EXPECT_EQ(import_mesh(mesh_, options).error().code, ErrorCode::internal);
}

TEST_F(ImporterProcess, LeavesNoDescriptorAndNoZombie) {
  ASSERT_TRUE(import_mesh(mesh_).ok());
  const std::size_t before = open_descriptors();
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(import_mesh(mesh_).ok());
    EXPECT_FALSE(import_by("exit 1").ok());
  }
  EXPECT_EQ(open_descriptors(), before);
  expect_no_children();
}

TEST_F(ImporterProcess, ManyThreadsImportAtOnce) {
  std::atomic<int> good{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 4; ++i) {
        const Result<ImportedMesh> imported = import_mesh(mesh_);
        if (imported.ok() && imported->mesh.size() == 36) ++good;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(good, 32);
  expect_no_children();
}

TEST_F(ImporterProcess, AnIgnoredChildSignalDoesNotMatter) {
  struct sigaction ignore {};
  struct sigaction before {};
  ignore.sa_handler = SIG_IGN;
  ::sigaction(SIGCHLD, &ignore, &before);
  EXPECT_TRUE(import_mesh(mesh_).ok());
  EXPECT_FALSE(import_by("exit 1").ok());
  ::sigaction(SIGCHLD, &before, nullptr);
}

TEST_F(ImporterProcess, SignalsWhileWaitingDoNotMatter) {
  struct sigaction handle {};
  struct sigaction before {};
  handle.sa_handler = [](int) {};
  ::sigaction(SIGUSR1, &handle, &before);
  std::atomic<bool> done{false};
  const pthread_t target = ::pthread_self();
  std::thread sender([&] {
    while (!done) {
      ::pthread_kill(target, SIGUSR1);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(import_mesh(mesh_).ok());
  done = true;
  sender.join();
  ::sigaction(SIGUSR1, &before, nullptr);
}

}  // namespace
}  // namespace crashrank
