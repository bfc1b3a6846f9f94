# SPDX-License-Identifier: Apache-2.0
# The headers that are installed below include/phalanx: what users of the libraries include, and what these headers include in turn.
# A test holds the lists to that (tests/project/include_rules_test.cpp).
set(PHALANX_PUBLIC_HEADERS # of phalanx::phalanx
    core/latest.h
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
set(PHALANX_SIMULATION_PUBLIC_HEADERS # of phalanx::simulation
    core/random.h
    device/channel_map.h
    device/device.h
    device/exoskeleton.h
    device/fault.h
    device/moment_arm.h
    device/motion.h
    grasp/grasp_type.h
    hand/sensor_mapping.h
    scene/build_model.h
    scene/data_paths.h
    scene/device_file.h
    scene/motion_file.h
    scene/patient_file.h
    scene/scene.h
    scene/scene_trial.h
    simulation/closed_loop/closed_loop.h
    simulation/closed_loop/stability_criterion.h
    simulation/closed_loop/trial.h
    simulation/patient.h
    simulation/plant.h
    simulation/press_intent.h
    simulation/press_plan.h
    simulation/simulate.h
    simulation/simulated_exoskeleton.h
    simulation/step_times.h
    simulation/transmission.h
    simulation/trial_setup.h)
set(PHALANX_STATION_PUBLIC_HEADERS # of phalanx::station
    device/calibration.h
    device/calibration_session.h
    device/clock.h
    device/link/phalanx_link.h
    device/measured_range.h
    device/range_session.h
    device/sample_queue.h
    device/stillness.h
    scene/calibration_file.h
    scene/range_file.h
    station/deadline_statistics.h
    station/realtime.h
    station/safety_settings.h
    station/session.h
    station/session_change.h
    station/session_statistics.h
    station/station.h
    station/station_model.h
    station/station_view.h)
set(PHALANX_RECORDING_PUBLIC_HEADERS # of phalanx::recording
    record/recording_keys.h
    record/recordings.h
    record/replay.h
    record/replay_visitor.h
    record/session_recorder.h
    record/step_recorder.h)
set(PHALANX_C_PUBLIC_HEADERS phalanx.h) # of phalanx::c
