// The stories. A story is an experiment that runs in steps. Each step stops at an interesting instant, and two sentences explain it.

/** A path that turns the head to the left and right by some degrees, with a period in seconds. */
const swing = (degrees, period) => (seconds) => [degrees * Math.sin((2 * Math.PI * seconds) / period), 0];
const rest = () => [0, 0];

const HEAD = { "head.motion": "live.csv", "head.tracker": "fastrak", "head.predict": "none" };
const MS = 1e9;

/**
 * Each step has a `title` and two sentences (`say`). The step runs for `ms` of simulated time, `slower` times slower than the
 * machine. With `until`, the step ends at an event, after at most `ms`. The step can then run for `then` more milliseconds,
 * `thenSlower` times slower than the machine. At the end of the step, the page shows the sentence `paused`. `show` names the parts
 * of the page that are visible besides the pictures. A step without a `path` continues the path of the previous step. With `hand`,
 * the visitor moves the head.
 */
export const STORIES = {
  lag: {
    name: "Feel the lag",
    settings: { pipeline: "rendering-control", scene: "gallery", display: "ntsc", fields: "3600", ...HEAD },
    beside: "slats",
    eyes: 1,
    steps: [
      {
        title: "Two pictures of one world",
        say: "The yellow wire frame is the world as it really is at this moment. The picture behind the wire frame is what the machine shows in your headset.",
        path: rest, ms: 700, show: ["wire", "age"],
        paused: "The head is at rest, so the picture agrees with the world.",
      },
      {
        title: "The head turns",
        say: "Now the head turns to the left and to the right. The picture lags behind the wire frame, because the machine drew it for an earlier pose of the head.",
        path: swing(18, 2), ms: 1050, slower: 2, show: ["wire", "age"],
        paused: "The run has stopped in the middle of a turn. In a headset, this gap between world and picture makes the picture seem to swim.",
      },
      {
        title: "This is latency",
        say: "Latency is the time from the measurement of the head to the light of the picture. The number beside each name is the age of the picture: the older the picture, the wider the gap.",
        ms: 320, slower: 6, show: ["wire", "age"],
        paused: "Compare the two ages. The scene, the head and the boards are the same.",
      },
      {
        title: "Where the time goes",
        say: "Rendering Control draws one eye after the other, and each picture passes through several stages. A finished picture then waits for the next field of the screen, which begins every sixtieth of a second.",
        ms: 120, slower: 6, show: ["wire", "age", "latency"],
        paused: "Each coloured piece of a bar is a stage or a wait.",
      },
      {
        title: "How Slats is faster",
        say: "Slats keeps the whole screen in the drawing boards (renderers), so each triangle is drawn as soon as its position is known. All stages fit into one field, but only for scenes of at most about 140 triangles.",
        ms: 320, slower: 6, show: ["wire", "age", "latency"],
        paused: "In the same turn, Slats has the smaller gap, because its picture is younger.",
      },
      {
        title: "Now you",
        say: "Drag across a picture to turn the head, or move the focus to a picture and use the arrow keys. In the laboratory you can change the scene, the pipeline and the tracker of this experiment.",
        path: rest, ms: 600_000, slower: 1, show: ["wire", "age", "latency"], hand: true,
        paused: "",
      },
    ],
  },
  inside: {
    name: "Inside the machine",
    settings: { pipeline: "rendering-control", scene: "gallery", display: "ntsc", fields: "3600", "head.motion": "sine:14:0.4", "head.tracker": "fastrak", "head.predict": "none" },
    eyes: 1,
    begin: 400,
    steps: [
      {
        title: "Boards on a ring",
        say: "The machine is a set of computer boards around a fast ring, over which the boards send messages. In this story, time runs up to 8,000 times slower, so you can follow the messages.",
        ms: 5, slower: 400, show: ["diagram", "regions"],
        paused: "Boards that wait are grey. Each board that works shows its stage.",
      },
      {
        title: "1. The pose of the head",
        say: "The host reads the tracker and sends the pose of the head (position and direction) to the graphics processors. From the measurement of this pose on, the picture grows older.",
        until: "pose", ms: 200, slower: 60, then: 0.06, thenSlower: 8000, show: ["diagram", "regions", "age"],
        paused: "The message of the host is on the ring.",
      },
      {
        title: "2. TRANSFORM",
        say: "Each graphics processor (GP) computes the positions of its triangles on the screen. The GP then sorts the triangles into bins, one for each region of 128 by 128 pixels.",
        until: "transform", ms: 200, slower: 60, show: ["diagram", "regions", "age"],
        paused: "The GPs work at the same time, and the first GPs already send commands. The renderers still copy the previous picture.",
      },
      {
        title: "3. RENDER",
        say: "A renderer has a small processor for each of its 16,384 pixels, and all of these processors execute the same command together. A dashed green frame in the picture marks a region that a renderer draws now.",
        until: "draw", ms: 200, slower: 100, show: ["diagram", "regions", "age"],
        paused: "The renderers draw new regions while they still copy the pixels of other regions.",
      },
      {
        title: "4. COPY",
        say: "Finished regions go over the ring into the memory of the picture (the frame buffer), one at a time. A yellow frame marks the region that is copied now, while the renderers already draw other regions.",
        until: "copy", ms: 200, slower: 100, then: 1.5, thenSlower: 800, show: ["diagram", "regions", "age"],
        paused: "The screen still shows an older picture.",
      },
      {
        title: "5. Swap",
        say: "When all regions of both eyes have arrived, the screen changes to the new picture at the start of the next field. Every earlier stage has added to the age of the picture.",
        until: "swap", ms: 300, slower: 20, show: ["diagram", "regions", "age", "latency"],
        paused: "The new picture is now on the screen. The number beside the name is its age.",
      },
    ],
  },
  race: {
    name: "Race the beam",
    settings: { pipeline: "jitp-scanline-racing", scene: "aircraft", triangles: "30", display: "ntsc", fields: "3600", "head.motion": "sine:20:0.5", "head.tracker": "fastrak", "head.predict": "none" },
    eyes: 1,
    begin: 300,
    steps: [
      {
        title: "A screen is drawn in lines",
        say: "A television screen of that time does not light all of its pixels at once. Sixty times a second, a beam draws lines from the top of the screen to the bottom.",
        until: "line", value: 150, ms: 60, slower: 60, show: ["beam"],
        paused: "The bright line is the beam. Below the beam, the screen still shows the previous field.",
      },
      {
        title: "Waiting costs time",
        say: "Most machines finish the whole picture before the beam begins to draw it. So the last line is at least one field (17 thousandths of a second) older than necessary.",
        until: "line", value: 420, ms: 60, slower: 60, show: ["beam"],
        paused: "The beam is now near the bottom of the picture.",
      },
      {
        title: "Just in time",
        say: "In this story, each line is drawn from the newest measurement of the head. The pixels of a line arrive in the memory just before the beam lights them.",
        until: "strip", value: 200, ms: 60, slower: 120, show: ["beam", "regions", "diagram"],
        paused: "The yellow frame marks the strip that is copied now. The strip is just ahead of the beam.",
      },
      {
        title: "The race",
        say: "Strip after strip is copied, and the beam follows close behind. A late strip would light with old pixels, so this method needs a scene with few triangles.",
        until: "strip", value: 330, ms: 60, slower: 120, show: ["beam", "regions", "diagram"],
        paused: "Watch the messages. Small messages travel all the time, instead of whole regions.",
      },
      {
        title: "What is left of the lag",
        say: "The head turns, and the gap to the wire frame of the real world is much smaller than under Rendering Control. A part of this gap is the delay of the tracker and its cable, which no pipeline can remove.",
        ms: 900, slower: 4, show: ["beam", "wire", "age"],
        paused: "In the laboratory, choose rendering-control in the list Beside it, press Build, and compare.",
      },
    ],
  },
  turn: {
    name: "Turn for free",
    settings: { pipeline: "arp-full-line", scene: "gallery", display: "arp", fields: "3600", ...HEAD },
    eyes: 1,
    begin: 500,
    steps: [
      {
        title: "Draw all directions",
        say: "What if the picture did not depend on the direction of the head? Here the machine draws the world in all directions: on the six faces of a cube around the eye.",
        path: rest, ms: 300, slower: 2, show: ["faces"],
        paused: "The six faces are laid out like an unfolded box: left, ahead, right, behind, above and below.",
      },
      {
        title: "Look up the picture of the eye",
        say: "While the beam runs, the display chooses a point on one of the faces for each pixel of your view. The display needs only the direction of the head, and nothing is drawn again.",
        until: "line", value: 240, ms: 60, slower: 60, show: ["faces", "beam"],
        paused: "The display looks up each pixel just before the pixel lights.",
      },
      {
        title: "Turn the head",
        say: "The head turns, and the picture turns at once, although the faces in the memory are older. The wire frame of the real world is much closer to the picture than under Rendering Control.",
        path: swing(18, 2), ms: 1050, slower: 2, show: ["faces", "wire"],
        paused: "The run has stopped in a fast turn. The remaining gap comes from the delay of the tracker, and not from the drawing.",
      },
      {
        title: "What is not free",
        say: "Only turning is free. When the head moves to another place, or when objects move, the machine must draw the faces again, as slowly as before.",
        ms: 300, slower: 4, show: ["faces", "wire", "diagram"],
        paused: "The boards draw new faces all the time. The display does not wait for new faces.",
      },
      {
        title: "Now you",
        say: "Drag across the picture to turn the head, or move the focus to the picture and use the arrow keys. In the laboratory, choose the pipeline rendering-control and the display ntsc to see the difference.",
        path: rest, ms: 600_000, slower: 1, show: ["faces", "wire"], hand: true,
        paused: "",
      },
    ],
  },
};

/** The moving picture of the first screen. */
export const FIRST_SCREEN = {
  settings: { pipeline: "slats", scene: "gallery", display: "ntsc", fields: "3600", ...HEAD },
  path: swing(12, 5),
};

/** Returns the story and the step of an address such as `story=lag&step=2`, or null without a story. */
export function storyOf(given) {
  const name = given.get("story");
  if (!Object.hasOwn(STORIES, name ?? "")) return null;
  const step = Math.min(Math.max(1, Math.trunc(Number(given.get("step") ?? 1)) || 1), STORIES[name].steps.length);
  return { name, step: step - 1 };
}

export const inPs = (ms) => Math.round(ms * MS);
