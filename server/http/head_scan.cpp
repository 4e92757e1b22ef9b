#include "server/http/head_scan.h"

namespace translucube::server {

using api::ProblemCode;

HeadScan::State HeadScan::refuse(ProblemCode code, const char* detail) {
  fault_ = api::Problem{code, detail, {}};
  return State::faulty;
}

HeadScan::State HeadScan::scan(std::string_view received) {
  if (whole_) return State::whole;
  if (fault_) return State::faulty;
  for (; at_ < received.size(); ++at_) {
    const auto byte = static_cast<unsigned char>(received[at_]);
    const bool after_cr = at_ > line_ && received[at_ - 1] == '\r';
    // RFC 9112, 2.2: a CR alone is refused. A LF alone may be taken for a line's end, and is not
    // here, as others may not.
    if (after_cr != (byte == '\n'))
      return refuse(ProblemCode::malformed_http, "A line does not end in CR LF.");
    if (byte == '\n') {
      if (at_ - line_ == 1) {
        ++at_;
        whole_ = true;
        return State::whole;
      }
      ++lines_;
      line_ = at_ + 1;
    } else if ((byte < ' ' && byte != '\t' && byte != '\r') || byte == 0x7f) {
      // RFC 9110, 5.5: NUL and its like are dangerous in a field.
      return refuse(ProblemCode::malformed_http, "The head has a control character.");
    }
    if (at_ - line_ > longest_line && line_ <= at_)
      return lines_ == 0 ? refuse(ProblemCode::uri_too_long, "The URI is too long.")
                         : refuse(ProblemCode::headers_too_large, "A header is too long.");
    if (at_ >= largest_head)
      return refuse(ProblemCode::headers_too_large, "The headers are too long.");
  }
  return State::begun;
}

}  // namespace translucube::server
