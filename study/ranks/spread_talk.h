/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What ranks say to each other while they share work: rank 0 with each of the others. For spread*.c
 * alone. */
#ifndef BR_STUDY_RANKS_SPREAD_TALK_H
#define BR_STUDY_RANKS_SPREAD_TALK_H

#include "study/grid/observer.h"
#include "study/ranks/bench_thread.h"
#include "study/ranks/ranks.h"

/* What is said, and what follows it. */
enum br_talk {
    /* to rank 0 */
    BR_TALK_JOIN,  /* the studies' fingerprint */
    BR_TALK_DONE,  /* the group's index, and its results */
    BR_TALK_FAIL,  /* an error that ends the call */
    BR_TALK_LEAVE, /* the error that the program ends with, or none */
    /* from rank 0 */
    BR_TALK_GIVE, /* a group's index */
    BR_TALK_STOP, /* the error that ends the call */
    BR_TALK_ALL,  /* the results of all groups */
    BR_TALK_OVER, /* whether it aborts: its program ends */
    /* both ways */
    BR_TALK_BEAT, /* to rank 0: the fraction of the group that is done */
};

/* A call of br_spread on one rank. */
struct br_spread_call {
    struct br_study *studies;
    size_t count;
    struct br_units units;
    struct br_work_bench bench;
    const struct br_observer *observer; /* may be NULL */
    unsigned long long fingerprint;
    struct br_error stop; /* why the call has to end; status BR_OK: it goes on */
};

/* What is known of the other ranks beyond a call. */
struct br_talk_state {
    bool lost;           /* some rank is not heard from any more */
    bool over;           /* rank 0 has ended */
    bool *left;          /* of each rank: whether it has */
    double *quiet;       /* of each rank: how long it has said nothing, s */
    double looked, beat; /* when those were brought up to date, and when it last spoke, s */
};
struct br_talk_state *br_talk(void); /* NULL: out of memory */
void br_talk_forget(void);

/* How often messages are looked for, s. */
extern const double br_talk_patience;

/* Keeps the first reason why a call has to end. */
void br_talk_stop(struct br_spread_call *call, const struct br_error *why);

/* Sends an error, or that there is none. */
enum br_status br_talk_send_error(int to, enum br_talk kind, const struct br_error *what,
                                  struct br_error *err);

/* The error in a message. */
struct br_error br_talk_error(const struct br_message *message);

/* The next message, if one has come (out). Whoever has spoken is not quiet. */
enum br_status br_talk_receive(struct br_message *message, bool *came, struct br_error *err);

/* Whether it is time to say that this rank is there. */
bool br_talk_beat_due(void);

/* Fails with BR_IO where one of the ranks first .. last - 1 that have not left has been quiet for
 * too long. Only the time that this process was running counts, so that a job that was suspended as
 * a whole goes on. */
enum br_status br_talk_listen(int first, int last, struct br_error *err);

/* After a while in which nobody listened. */
void br_talk_start_listening(void);

/* The two sides of br_spread. */
enum br_status br_spread_hub(struct br_spread_call *call, struct br_error *err);
enum br_status br_spread_worker(struct br_spread_call *call, struct br_error *err);

#endif
