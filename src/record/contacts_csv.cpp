// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/contacts_csv.h"

namespace phalanx {

ContactsCsv::ContactsCsv(const std::filesystem::path& file) : out_(file) {
  out_.text("tick,segment,px_m,py_m,pz_m,nx,ny,nz,force_n,tx_n,ty_n,tz_n,spin_nm,mu,slip\n");
}

void ContactsCsv::write(const Snapshot& snapshot) {
  for (const ContactPoint& at : snapshot.contact_points) {
    out_.integer(snapshot.tick);
    out_.text(",");
    out_.text(segment_name(at.segment));
    for (const double value :
         {at.point.x(), at.point.y(), at.point.z(), at.normal.x(), at.normal.y(), at.normal.z(), at.force,
          at.friction.x(), at.friction.y(), at.friction.z(), at.spin, at.coefficient}) {
      out_.text(",");
      out_.number(value);
    }
    out_.text(at.slips ? ",1\n" : ",0\n");
  }
}

}  // namespace phalanx
