// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/contacts_csv.h"

#include <gmock/gmock.h>

#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using testing::read_file;
using testing::TemporaryFolder;

// Every field gets a number of its own, so that a swapped column cannot hide.
TEST(ContactsCsv, HasOneRowForEachPointAndNoneForATickWithoutContact) {
  const TemporaryFolder folder;
  ContactsCsv csv(folder / "contacts.csv");
  Snapshot snapshot;
  snapshot.tick = 7;
  csv.write(snapshot);
  snapshot.tick = 8;
  snapshot.contact_points.count = 2;
  snapshot.contact_points.point[0] = {.segment = 5,
                                      .point = Vec3(1, 2, 3),
                                      .normal = Vec3(4, 5, 6),
                                      .force = 7,
                                      .friction = Vec3(8, 9, 10),
                                      .spin = 11.5,
                                      .coefficient = 0.5,
                                      .slips = true};
  snapshot.contact_points.point[1].segment = 14;
  csv.write(snapshot);
  csv.commit();
  EXPECT_EQ(read_file(folder / "contacts.csv"),
            "tick,segment,px_m,py_m,pz_m,nx,ny,nz,force_n,tx_n,ty_n,tz_n,spin_nm,mu,slip\n"
            "8,index-finger-phalanx-distal,1,2,3,4,5,6,7,8,9,10,11.5,0.5,1\n"
            "8,pinky-finger-phalanx-distal,0,0,0,0,0,0,0,0,0,0,0,0,0\n");
}

}  // namespace
}  // namespace phalanx
