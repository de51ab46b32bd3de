#define ASK ask_everything_v3
#define LAYOUT layout_v3
#include "query_body.hpp"
