// The table of all candidates: sorted, filtered, and drawn only where it is seen, so that ten
// thousand rows stay fluent. A click opens what is known of a candidate.

const PLACE = 0, BRACKET = 1, NAME = 2, WORDS = 3, SCORE = 4, INTERVAL = 5, VALUE = 6, LOW = 7,
  HIGH = 8, CONTACT = 9, TIME = 10, WARNINGS = 11;
const FEW_ROWS = 60;

class RankingTable {
  // `choose` is called with the row that is opened.
  constructor(choose) {
    this.choose = choose;
    this.holder = document.getElementById("rows");
    this.table = this.holder.querySelector("table");
    this.body = this.table.tBodies[0];
    this.filter = document.getElementById("filter");
    this.listed = document.getElementById("listed");
    this.isLong = DATA.rows.length > FEW_ROWS;
    this.holder.classList.toggle("long", this.isLong);
    // Of long tables, as the style sheet says for wide and for narrow pages.
    this.narrow = matchMedia("(max-width: 700px)");
    const isCalm = DATA.rows.every((row) => !row[WARNINGS]);
    this.table.classList.toggle("calm", isCalm);
    this.columns = isCalm ? 4 : 5;
    this.open = null;
    this.openHeight = 0;
    this.sorted = {column: 0, isDown: false};
    this.order = DATA.rows.map((_, i) => i);
    this.table.tHead.rows[0].querySelectorAll("th").forEach((head, column) => {
      const button = element("button", {type: "button"}, head.textContent);
      head.replaceChildren(button);
      button.addEventListener("click", () => this.sort(column));
    });
    this.filter.addEventListener("input", () => this.arrange());
    this.holder.addEventListener("scroll", () => this.draw());
    window.addEventListener("resize", () => this.draw());
    this.narrow.addEventListener("change", () => this.draw(true));
    this.arrange();
  }

  get rowHeight() { return this.narrow.matches ? 112 : 46; }

  sort(column) {
    this.sorted = {column, isDown: this.sorted.column === column && !this.sorted.isDown};
    this.arrange();
  }

  arrange() {
    const words = this.filter.value.toLowerCase().split(/\s+/).filter((word) => word);
    const fits = (row) => {
      const text = [NAME, WORDS, CONTACT, WARNINGS].map((i) => row[i]).join(" ").toLowerCase();
      return words.every((word) => text.includes(word));
    };
    this.order = DATA.rows.map((_, i) => i).filter((i) => fits(DATA.rows[i]));
    const {column, isDown} = this.sorted;
    const key = [(i) => i, (i) => DATA.rows[i][NAME], (i) => DATA.rows[i][VALUE] ?? Infinity,
      (i) => DATA.rows[i][TIME] < 0 ? Infinity : DATA.rows[i][TIME],
      (i) => DATA.rows[i][WARNINGS]][column];
    this.order.sort((a, b) => {
      const [p, q] = [key(a), key(b)];
      return (p < q ? -1 : p > q ? 1 : a - b) * (isDown ? -1 : 1);
    });
    this.table.tHead.rows[0].querySelectorAll("th").forEach((head, i) => {
      head.setAttribute("aria-sort", i !== column ? "none" : isDown ? "descending" : "ascending");
    });
    this.listed.textContent = this.order.length === DATA.rows.length ? ""
      : `${this.order.length} of ${DATA.rows.length} candidates`;
    this.table.setAttribute("aria-rowcount", this.order.length + 1);
    if (this.isLong) this.holder.scrollTop = 0;
    this.draw(true);
  }

  // Draws the rows that are seen, and some above and below.
  draw(isForced) {
    let first = 0;
    let last = this.order.length;
    const openAt = this.open === null ? -1 : this.order.indexOf(this.open);
    if (this.isLong) {
      const beyond = openAt >= 0 ? this.openHeight : 0;
      const top = this.holder.scrollTop;
      const count = Math.ceil(this.holder.clientHeight / this.rowHeight) + 16;
      first = clamp(Math.floor((top - beyond) / this.rowHeight) - 8, 0, this.order.length);
      last = Math.min(this.order.length, Math.floor(top / this.rowHeight) + count);
    }
    if (!isForced && this.drawn && this.drawn[0] === first && this.drawn[1] === last) return;
    this.drawn = [first, last];
    this.putBack();
    const above = first * this.rowHeight + (openAt >= 0 && openAt < first ? this.openHeight : 0);
    const below = (this.order.length - last) * this.rowHeight +
      (openAt >= last ? this.openHeight : 0);
    const rows = [];
    if (above > 0) rows.push(this.space(above));
    for (let i = first; i < last; ++i) {
      rows.push(this.row(this.order[i], i));
      if (i === openAt) rows.push(this.detail(this.open));
    }
    if (below > 0) rows.push(this.space(below));
    this.body.replaceChildren(...rows);
    const detail = this.body.querySelector("tr.detail");
    if (detail) this.openHeight = detail.offsetHeight;
  }

  space(height) {
    const cell = element("td", {colspan: this.columns});
    cell.style.height = height + "px";
    return element("tr", {class: "space", "aria-hidden": "true"}, cell);
  }

  row(index, position) {
    const row = DATA.rows[index];
    const made = element("tr", {"data-row": index, class: row[BRACKET],
      "aria-rowindex": position + 2});
    const place = element("td", {class: "place"}, row[PLACE] +
      (row[BRACKET] === "tied" ? " tied" : ""));
    this.addBracket(place, index);
    const open = element("button", {type: "button", class: "open",
      "aria-expanded": String(this.open === index)}, row[NAME]);
    const name = element("td", {}, open);
    if (row[WORDS]) name.append(element("span", {class: "words"}, row[WORDS]));
    const score = element("td", {class: "score"}, this.bar(row), row[SCORE]);
    if (row[INTERVAL]) score.append(element("span", {class: "interval"}, row[INTERVAL]));
    const warnings = element("td");
    if (row[WARNINGS]) warnings.append(element("em", {}, row[WARNINGS]));
    made.append(place, name, score,
      element("td", {class: "contact", title: row[CONTACT]}, element("span", {}, row[CONTACT])), warnings);
    made.addEventListener("click", () => this.toggle(index));
    return made;
  }

  // A bracket joins places that are tied, or that the next may overtake.
  addBracket(cell, index) {
    if (this.sorted.column !== 0 || this.filter.value) return;
    const joins = (i) => {
      const [row, next] = [DATA.rows[i], DATA.rows[i + 1]];
      return row && next && (row[BRACKET] === "near" ||
        (row[BRACKET] === "tied" && row[PLACE] === next[PLACE]));
    };
    const [up, down] = this.sorted.isDown ? [joins(index), joins(index - 1)]
      : [joins(index - 1), joins(index)];
    if (up) cell.classList.add("joins-up");
    if (down) cell.classList.add("joins-down");
    if (up || down) cell.title = "Places in one bracket are not certain against each other.";
  }

  bar(row) {
    const share = (value) => DATA.full > 0 ? 100 * clamp((value ?? DATA.full) / DATA.full, 0, 1) : 0;
    const bar = element("span", {class: "bar", "aria-hidden": "true"});
    bar.style.setProperty("--share", share(row[VALUE]) + "%");
    if (row[HIGH] !== row[LOW]) {
      const range = element("span", {class: "range"});
      range.style.left = share(row[LOW]) + "%";
      range.style.width = Math.max(1, share(row[HIGH]) - share(row[LOW])) + "%";
      bar.append(range);
    }
    return bar;
  }

  toggle(index) {
    this.open = this.open === index ? null : index;
    this.openHeight = 0;
    this.draw(true);
    if (this.open !== null) this.choose(index);
    const button = this.body.querySelector(`tr[data-row="${index}"] .open`);
    if (button) button.focus({preventScroll: true});
  }

  // What is known of a candidate stands in the page for print, and moves here when it is opened.
  detail(index) {
    const cell = element("td", {colspan: this.columns});
    const section = document.getElementById("c" + (index + 1));
    if (section) {
      cell.append(section);
      // On narrow pages every figure of a contact stands behind its title.
      for (const {tHead, tBodies} of section.querySelectorAll(".contacts")) {
        for (const {cells} of tBodies[0].rows) {
          [...cells].forEach((each, i) => each.dataset.title = tHead.rows[0].cells[i].textContent);
        }
      }
    } else cell.append("Only the best candidates and the worst are described; the JSON answer has all.");
    const row = element("tr", {class: "detail"}, cell);
    cell.addEventListener("click", (event) => event.stopPropagation());
    return row;
  }

  putBack() {
    const holder = document.getElementById("candidates");
    for (const section of this.body.querySelectorAll("section.candidate")) {
      const number = Number(section.id.slice(1));
      const next = [...holder.children].find((each) => Number(each.id.slice(1)) > number);
      holder.insertBefore(section, next || null);
    }
  }

  // Paper has the first rows of a long table, and no scrolling.
  print() {
    this.open = null;
    this.putBack();
    const most = 12;
    if (DATA.rows.length > 2 * most) {
      const rest = element("td", {colspan: this.columns}, `${DATA.rows.length - most} more are left out.`);
      this.body.replaceChildren(
        ...DATA.rows.slice(0, most).map((_, i) => this.row(i, i)), element("tr", {}, rest));
      this.drawn = null;
    } else {
      this.draw(true);
    }
  }
}

