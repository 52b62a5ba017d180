"""Ask SPaRGE about a sensor_msgs/PointCloud2 with Python's own library, in any ROS."""

import base64
import json
import urllib.error
import urllib.parse
import urllib.request


def ask_sparge(message, task, url="http://127.0.0.1:8000", timeout_s=30.0, **parameters):
    """Return the answer of SPaRGE as a dictionary; `header` and `poses` are a PoseArray.

    Parameters
    ----------
    message : sensor_msgs.msg.PointCloud2
        Its frame and its time are those of the answer.
    task : str
        A name from GET /tasks.
    url : str
        Of the backend.
    timeout_s : float
        How long to wait.
    **parameters
        Others of POST /grasp: gripper="robotiq_2f85", pose_of="robotiq_85_base_link", ...

    Raises
    ------
    RuntimeError
        What the backend refused, in its words.
    """
    stamp = message.header.stamp
    body = {
        "header": {
            "stamp": {"sec": stamp.sec, "nanosec": stamp.nanosec},
            "frame_id": message.header.frame_id,
        },
        "height": message.height,
        "width": message.width,
        "fields": [
            {"name": each.name, "offset": each.offset, "datatype": each.datatype}
            for each in message.fields
        ],
        "is_bigendian": message.is_bigendian,
        "point_step": message.point_step,
        "row_step": message.row_step,
        "data": base64.b64encode(bytes(message.data)).decode(),
        "is_dense": message.is_dense,
    }
    query = urllib.parse.urlencode({"task": task, "format": "pose_array", **parameters})
    request = urllib.request.Request(
        f"{url}/grasp?{query}",
        data=json.dumps(body).encode(),
        headers={"Content-Type": "application/json"},
    )
    try:
        with urllib.request.urlopen(request, timeout=timeout_s) as answer:
            return json.load(answer)
    except urllib.error.HTTPError as error:
        raise RuntimeError(json.load(error)["error"]["message"]) from error
