// Loads the page anew as soon as the server that it came from has another version of it.
(async () => {
  const version = document.body.dataset.version;
  for (;;) {
    try {
      const answer = await fetch("/version?after=" + version, {cache: "no-store"});
      if (answer.ok && await answer.text() !== version) return location.reload();
      if (answer.ok) continue;
    } catch {
      // The server is gone or starts again.
    }
    await new Promise((resolve) => setTimeout(resolve, 500));
  }
})();
