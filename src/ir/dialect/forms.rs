//! How each language puts the instructions of a pattern: what is read back word by word.

/// The set phrases of instructions. A name in braces stands for what differs from case to case.
#[derive(Debug)]
pub struct Forms {
    /// A round, and several.
    pub rnd: [&'static str; 2],
    /// A row, and several.
    pub row: [&'static str; 2],
    /// A stitch, and several.
    pub st: [&'static str; 2],
    /// Nothing stands between a number and its word: `R2: 6V`.
    pub glued: bool,
    /// Stitches into a ring.
    pub in_ring: &'static str,
    /// The ring alone.
    pub ring: &'static str,
    /// A chain to begin with.
    pub foundation: &'static str,
    /// The same, closed to a ring.
    pub tube: &'static str,
    /// Chains within a row.
    pub chain: &'static str,
    /// Behind chains that count as stitches.
    pub counts: &'static str,
    /// Loops passed over.
    pub skip: &'static str,
    /// Behind a stitch: the place of the stitch before.
    pub same: &'static str,
    /// Behind a stitch: a chain space.
    pub space: &'static str,
    /// Behind a stitch: the front loop only, and the back loop only.
    pub strands: [&'static str; 2],
    /// Stitches worked together, behind the stitch and their number.
    pub together: &'static str,
    /// A change of direction.
    pub turn: &'static str,
    /// Loops set aside.
    pub hold: &'static str,
    /// Loops left.
    pub leave: &'static str,
    /// The color that a row begins with, and a change within it.
    pub color: [&'static str; 2],
    /// A joining slip stitch.
    pub join: &'static str,
    /// Behind the last count: the last loops are drawn shut.
    pub close: &'static str,
    /// Behind the name of a part: copies.
    pub make: &'static str,
    /// Where a part comes from: joined pieces, and another part.
    pub origin: [&'static str; 2],
    /// Behind the places: loops held, and stitches worked around.
    pub taken: [&'static str; 2],
}

const PLAIN: Forms = Forms {
    rnd: ["Rnd", "Rnds"],
    row: ["Row", "Rows"],
    st: ["st", "sts"],
    glued: false,
    in_ring: "{stitch} in magic ring",
    ring: "magic ring",
    foundation: "Ch {n}",
    tube: "Ch {n}, join with a {slip} to form a ring",
    chain: "ch {n}",
    counts: "counts as {what}",
    skip: "{sk} {n}",
    same: " in same st",
    space: " in next ch-1 sp",
    strands: [" FLO", " BLO"],
    together: "tog",
    turn: "turn",
    hold: "hold {n} {st} for {part}",
    leave: "leave last {n} {st} unworked",
    color: ["with {color}", "change to {color}"],
    join: "join with sl st",
    close: "close",
    make: "make {n}",
    origin: ["join", "from"],
    taken: ["held", "surface"],
};

pub(super) static ENGLISH: Forms = PLAIN;

pub(super) static SPANISH: Forms = Forms {
    rnd: ["Vuelta", "Vueltas"],
    row: ["Fila", "Filas"],
    st: ["p", "p"],
    glued: false,
    in_ring: "{stitch} en un anillo mágico",
    ring: "anillo mágico",
    foundation: "{n} cad",
    tube: "{n} cad, unir con un {slip} en anillo",
    chain: "{n} cad",
    counts: "cuenta como {what}",
    skip: "saltar {n}",
    same: " en el mismo p",
    space: " en el siguiente esp",
    strands: [" FLO", " BLO"],
    together: "jun",
    turn: "girar",
    hold: "reservar {n} {st} para {part}",
    leave: "dejar los últimos {n} {st} libres",
    color: ["con {color}", "cambiar a {color}"],
    join: "unir con pd",
    close: "cerrar",
    make: "hacer {n}",
    origin: ["unir", "desde"],
    taken: ["reservados", "superficie"],
};

pub(super) static PORTUGUESE: Forms = Forms {
    rnd: ["Carreira", "Carreiras"],
    row: ["Fileira", "Fileiras"],
    st: ["p", "p"],
    glued: false,
    in_ring: "{stitch} no anel mágico",
    ring: "anel mágico",
    foundation: "{n} corr",
    tube: "{n} corr, unir com um {slip} em anel",
    chain: "{n} corr",
    counts: "conta como {what}",
    skip: "pular {n}",
    same: " no mesmo p",
    space: " no próximo esp",
    strands: [" AF", " AP"],
    together: "jun",
    turn: "virar",
    hold: "reservar {n} {st} para {part}",
    leave: "deixar os últimos {n} {st} livres",
    color: ["com {color}", "mudar para {color}"],
    join: "unir com pbx",
    close: "fechar",
    make: "fazer {n}",
    origin: ["unir", "desde"],
    taken: ["reservados", "superfície"],
};

pub(super) static FRENCH: Forms = Forms {
    rnd: ["Tour", "Tours"],
    row: ["Rang", "Rangs"],
    st: ["m", "m"],
    glued: false,
    in_ring: "{stitch} dans un cercle magique",
    ring: "cercle magique",
    foundation: "{n} ml",
    tube: "{n} ml, joindre avec une {slip} en cercle",
    chain: "{n} ml",
    counts: "compte comme {what}",
    skip: "sauter {n}",
    same: " dans la même m",
    space: " dans le prochain espace",
    strands: [" boucle avant", " boucle arrière"],
    together: "ens",
    turn: "tourner",
    hold: "réserver {n} {st} pour {part}",
    leave: "laisser les dernières {n} {st} libres",
    color: ["avec {color}", "changer pour {color}"],
    join: "joindre avec mc",
    close: "fermer",
    make: "faire {n}",
    origin: ["joindre", "depuis"],
    taken: ["réservées", "surface"],
};

pub(super) static GERMAN: Forms = Forms {
    rnd: ["Rd", "Rd"],
    row: ["Reihe", "Reihen"],
    st: ["M", "M"],
    glued: false,
    in_ring: "{stitch} in einen Fadenring",
    ring: "Fadenring",
    foundation: "{n} Lm",
    tube: "{n} Lm, verbinden mit einer {slip} zum Ring",
    chain: "{n} Lm",
    counts: "zählt als {what}",
    skip: "überspringe {n}",
    same: " in dieselbe M",
    space: " in den nächsten Lm-Bogen",
    strands: [" vMg", " hMg"],
    together: "zus",
    turn: "wenden",
    hold: "halte {n} {st} für {part}",
    leave: "lasse die letzten {n} {st} frei",
    color: ["mit {color}", "wechsle zu {color}"],
    join: "verbinden mit Km",
    close: "schließen",
    make: "mache {n}",
    origin: ["verbinden", "von"],
    taken: ["gehalten", "Oberfläche"],
};

pub(super) static NORWEGIAN: Forms = Forms {
    rnd: ["Omg", "Omg"],
    row: ["Rad", "Rader"],
    st: ["m", "m"],
    glued: false,
    in_ring: "{stitch} i magisk ring",
    ring: "magisk ring",
    foundation: "{n} lm",
    tube: "{n} lm, forbind med en {slip} til en ring",
    chain: "{n} lm",
    counts: "teller som {what}",
    skip: "hopp over {n}",
    same: " i samme m",
    space: " i neste lm-bue",
    strands: [" FLO", " BLO"],
    together: "sm",
    turn: "snu",
    hold: "hold av {n} {st} til {part}",
    leave: "la de siste {n} {st} stå",
    color: ["med {color}", "bytt til {color}"],
    join: "forbind med kjm",
    close: "stram",
    make: "lag {n}",
    origin: ["forbind", "fra"],
    taken: ["hvilende", "overflate"],
};

pub(super) static LETTERS: Forms = Forms {
    rnd: ["R", "R"],
    glued: true,
    foundation: "{n}CH",
    tube: "{n}CH, join with a {slip} to form a ring",
    chain: "{n}CH",
    space: " in next sp",
    join: "join with SL",
    ..PLAIN
};
