#include "mesh/importer/limits.hpp"
#include "mesh/importer/parse.hpp"
#include "mesh/importer/reply.hpp"
#include "mesh/importer/request.hpp"

#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

// Parses one mesh in a process of its own: what a damaged or hostile file does to the parser stays
// here. The mesh comes as standard input, the answer goes to standard output as
// import_protocol.hpp describes; the process is confined before it reads the first byte.

namespace {

using crashrank::Error;
using crashrank::ErrorCode;
using crashrank::make_error;
using crashrank::Result;

bool answer(const crashrank::importer::Request& request) {
  namespace importer = crashrank::importer;
  try {
    const Result<importer::Parsed> parsed = importer::parse(request);
    if (!parsed) return importer::send(parsed.error());
    return importer::send(parsed->mesh, parsed->dropped_triangles, parsed->warnings);
  } catch (const std::bad_alloc&) {
    return importer::send(importer::out_of_memory(request));
  } catch (const std::exception& failure) {
    return importer::send(make_error(ErrorCode::bad_input, failure.what(), "export it again"));
  }
}

}  // namespace

int main(int count, char** words) {
  const std::vector<std::string> arguments(words + (count > 0 ? 1 : 0), words + count);
  const Result<crashrank::importer::Request> request =
      crashrank::importer::parse_request(arguments);
  if (!request) {
    std::fprintf(stderr, "crashrank-import is run by the crashrank library: %s\n",
                 request.error().message().c_str());
    return 2;
  }
  if (!crashrank::importer::confine(request->memory_bytes, request->seconds)) {
    std::fputs("crashrank-import: cannot limit its memory and time\n", stderr);
    return 1;
  }
  // No destructors: the parser's recurse over whatever the file made it build.
  ::_exit(answer(*request) ? 0 : 1);
}
