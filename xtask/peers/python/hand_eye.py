"""Calibrates the trials of `crates/calibrate/examples/hand_eye_trials.rs` with each solver of OpenCV.

One argument, the file of trials; one line of JSON for each solver and trial, as that program prints them.
"""

import json
import sys
import time

import cv2
import numpy as np

HAND_EYE = {
    "OpenCV Tsai": cv2.CALIB_HAND_EYE_TSAI,
    "OpenCV Park": cv2.CALIB_HAND_EYE_PARK,
    "OpenCV Horaud": cv2.CALIB_HAND_EYE_HORAUD,
    "OpenCV Andreff": cv2.CALIB_HAND_EYE_ANDREFF,
    "OpenCV Daniilidis": cv2.CALIB_HAND_EYE_DANIILIDIS,
}
ROBOT_WORLD = {
    "OpenCV robot-world Shah": cv2.CALIB_ROBOT_WORLD_HAND_EYE_SHAH,
    "OpenCV robot-world Li": cv2.CALIB_ROBOT_WORLD_HAND_EYE_LI,
}


def matrix(numbers):
    x, y, z, a, b, c, w = numbers
    rotation = [
        [1 - 2 * (b * b + c * c), 2 * (a * b - c * w), 2 * (a * c + b * w)],
        [2 * (a * b + c * w), 1 - 2 * (a * a + c * c), 2 * (b * c - a * w)],
        [2 * (a * c - b * w), 2 * (b * c + a * w), 1 - 2 * (a * a + b * b)],
    ]
    result = np.eye(4)
    result[:3, :3] = rotation
    result[:3, 3] = [x, y, z]
    return result


def parts(matrices):
    return [m[:3, :3] for m in matrices], [m[:3, 3] for m in matrices]


def hand_eye(flanges, targets, method):
    # For a camera that stands still its place in the base comes out where the flange's inverse goes in.
    rotation, translation = cv2.calibrateHandEye(
        *parts([np.linalg.inv(m) for m in flanges]), *parts(targets), method=method
    )
    return rotation, translation


def robot_world(flanges, targets, method):
    # world → camera is target → camera; base → gripper is, for a camera that stands still, flange → base.
    _, _, rotation, translation = cv2.calibrateRobotWorldHandEye(
        *parts(targets), *parts(flanges), method=method
    )
    # gripper → camera: here base → camera.
    inverse = np.eye(4)
    inverse[:3, :3], inverse[:3, 3] = rotation, translation[:, 0]
    inverse = np.linalg.inv(inverse)
    return inverse[:3, :3], inverse[:3, 3:]


def errors(truth, rotation, translation):
    turn = rotation @ truth[:3, :3].T
    vector = [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
    angle = np.degrees(np.arctan2(np.linalg.norm(vector), np.trace(turn) - 1))
    shift = translation[:, 0] - truth[:3, 3]
    # The place of a fruit 0.8 m straight ahead of the camera.
    at_fruit = shift + (rotation - truth[:3, :3]) @ [0, 0, 0.8]
    return {
        "rotation_deg": float(angle),
        "translation_mm": float(1e3 * np.linalg.norm(shift)),
        "fruit_mm": float(1e3 * np.linalg.norm(at_fruit)),
    }


print(json.dumps({"version": cv2.__version__}))
for trial in json.load(open(sys.argv[1])):
    truth = matrix(trial["robot_from_camera"])
    flanges = [matrix(m) for m in trial["robot_from_flange"]]
    targets = [matrix(m) for m in trial["camera_from_target"]]
    for solve, methods in ((hand_eye, HAND_EYE), (robot_world, ROBOT_WORLD)):
        for name, method in methods.items():
            answer = {"case": trial["case"], "seed": trial["seed"], "method": name}
            start = time.perf_counter()
            try:
                rotation, translation = solve(flanges, targets, method)
                answer["milliseconds"] = 1e3 * (time.perf_counter() - start)
                if not (np.isfinite(rotation).all() and np.isfinite(translation).all()):
                    answer["refused"] = "not finite"
                else:
                    answer.update(errors(truth, rotation, translation))
            except (cv2.error, np.linalg.LinAlgError) as error:
                answer["milliseconds"] = 1e3 * (time.perf_counter() - start)
                answer["refused"] = str(error).strip().splitlines()[-1]
            print(json.dumps(answer))
