// Browsers load the modules of a page only from a server. A page that was opened as a file says so; page.js cannot.
if (location.protocol === "file:") {
  document.getElementById("loading-share").hidden = true;
  document.getElementById("loading-says").textContent =
    "This page was opened as a file, and browsers load its program only from a server. In the folder above this file, run python3 -m http.server, then open http://localhost:8000/live/ instead.";
}
