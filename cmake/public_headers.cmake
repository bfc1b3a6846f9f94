# SPDX-License-Identifier: Apache-2.0
# The headers that are installed below include/phalanx: what users of the three libraries include, and what these headers include in turn.
# A test holds the lists to that (tests/project/include_rules_test.cpp).
set(PHALANX_PUBLIC_HEADERS # of phalanx::phalanx
    core/math.h
    core/status.h
    mesh/objects.h
    mesh/primitives.h
    mesh/triangle_mesh.h
    hand/angle_origin.h
    hand/fit.h
    hand/hand_model.h
    hand/hand_parameters.h
    hand/hand_skin.h
    hand/joints.h
    contact/contact_parameters.h
    contact/object_model.h
    force/force_parameters.h
    force/haptic_parameters.h
    force/local_wall.h
    force/opening.h
    force/oscillation.h
    force/stabiliser.h
    step/haptic_step.h
    step/snapshot.h)
set(PHALANX_IMPORT_PUBLIC_HEADERS # of phalanx::import
    mesh/import.h
    mesh/mesh_report.h)
set(PHALANX_STATION_PUBLIC_HEADERS # of phalanx::station
    device/calibration.h
    device/calibration_session.h
    device/channel_map.h
    device/clock.h
    device/device.h
    device/fault.h
    device/latest.h
    device/link/phalanx_link.h
    device/measured_range.h
    device/motion.h
    device/range_session.h
    device/sample_queue.h
    device/stillness.h
    grasp/grasp_type.h
    scene/calibration_file.h
    scene/range_file.h
    scene/scene.h
    station/deadline_statistics.h
    station/realtime.h
    station/safety_settings.h
    station/session.h
    station/session_change.h
    station/session_statistics.h
    station/station.h
    station/station_model.h
    station/station_view.h)
